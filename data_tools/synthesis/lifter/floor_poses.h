// SPDX-License-Identifier: Apache-2.0
/// Floor poses: synthetic poses of people on the ground, which are rare in recorded motion.
///
/// A table of kinds of pose (on the back, belly or side; sitting with straight, bent or crossed legs; kneeling; hands
/// and knees, plank, bear, crab; deep squat; upside down), each a range of trunk tilts, leg angles and arm directions.
/// A sampled pose is settled: rotated about the edge of its support towards its centre of mass until the support grows,
/// by at most the angle that its kind allows.
#pragma once

#include <vector>

#include "data_tools/synthesis/lifter/lifter_body.h"
#include "data_tools/synthesis/lifter/lifter_window_options.h"

namespace bodyloom {

/// Number of kinds of floor pose and their names, for plots.
int NumFloorPoses();
const char* FloorPoseName(int kind);

/// Samples a pose of a kind with its heading along z: 24 rotations, at rest on the floor.
std::vector<Eigen::Quaternionf> RandomFloorPose(int kind, const LifterBody& body, const LifterPerson& person,
                                                HashRandom* random);

/// Moves the window's person to the ground: for the whole window, or going down or getting up in it, in one pose or
/// from one to another, still, rolling or crawling, with a part of the recorded movement of limbs and head. Sets
/// poses->clearance to 0 on the ground.
void AddFloorPoses(const LifterBody& body, const LifterPerson& person, const LifterWindowOptions& options,
                   HashRandom random, PoseSequence* poses);

}  // namespace bodyloom
