// SPDX-License-Identifier: Apache-2.0
/// A track as poses that pictures correct (render/avatar/learning/pose_refiner.h), and back.
#pragma once

#include <vector>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/track.h"
#include "bodyloom/render/avatar/learning/pose_refiner.h"

namespace bodyloom {

/// One a frame; without rotations where the track has no result.
std::vector<TrackedPose> TrackedPoses(const BodyModel& body, const Track& track);

/// The track with its corrected frames' poses, places, joints and landmarks; all else, and every joint's axis-angle that
/// has no correction, stays byte for byte. joint_sigma stays the track's own. `refiner` was made of TrackedPoses() of
/// this track.
Track RefinedTrack(const BodyModel& body, const Track& track, const PoseRefiner& refiner,
                   const PoseCorrections& corrections);

}  // namespace bodyloom
