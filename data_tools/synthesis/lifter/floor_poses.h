// SPDX-License-Identifier: Apache-2.0
/// Floor poses: people on the ground, of whom recorded motion holds too little.
///
/// A table of ways to be down there (on the back, belly or side; sitting with straight, bent or crossed legs; kneeling;
/// hands and knees, plank, bear, crab; deep squat; upside down), each a range of trunk tilts, leg angles and arm
/// directions. A drawn pose is put to rest: turned about the edge of what touches the floor, towards its centre of
/// mass, until it lies on more of itself, by no more than its kind of pose allows.
#pragma once

#include <vector>

#include "data_tools/synthesis/lifter/lifter_body.h"
#include "data_tools/synthesis/lifter/lifter_window_options.h"

namespace bodyloom {

/// Number of kinds of floor pose and their names, for pictures.
int NumFloorPoses();
const char* FloorPoseName(int kind);

/// One random pose of a kind with its heading along z: 24 rotations, at rest on the floor.
std::vector<Eigen::Quaternionf> RandomFloorPose(int kind, const LifterBody& body, const LifterPerson& person,
                                                HashRandom* random);

/// Puts the window's person on the ground: for the whole window or going down or getting up in it, in one pose or from
/// one to another, still or rolling or crawling, with some of the recorded movement of limbs and head left in.
/// poses->clearance becomes 0 on the ground.
void AddFloorPoses(const LifterBody& body, const LifterPerson& person, const LifterWindowOptions& options,
                   HashRandom random, PoseSequence* poses);

}  // namespace bodyloom
