// SPDX-License-Identifier: Apache-2.0
/// Where a person's ankles are in the frames of a clip, and what the lifter says of the feet.
#pragma once

#include <array>
#include <vector>

#include "bodyloom/geometry/observations.h"
#include "bodyloom/tracking/initialise/ground_plane.h"
#include "bodyloom/tracking/initialise/lifted_landmarks.h"
#include "bodyloom/tracking/initialise/lifter_reading.h"
#include "bodyloom/tracking/sequence_problem.h"

namespace bodyloom {

/// Of each frame of `problem`, which are `frames` of the clip that `lifted` and `keypoints` hold all frames of: both
/// ankles where the problem's states have them (for weak perspective as far away as FrameLayout::BodyPlace), and where
/// the camera was. A foot is seen where the detector is sure of its ankle.
std::vector<std::array<FootPlace, 2>> SeenFeet(const SequenceProblem& problem, const std::vector<int>& frames,
                                               const std::vector<LiftedFrame>& lifted, const LiftedLandmarks& landmarks,
                                               const KeypointSequence& keypoints);

}  // namespace bodyloom
