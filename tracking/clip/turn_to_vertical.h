// SPDX-License-Identifier: Apache-2.0
/// Turns the lifter's landmarks to a vertical that is better known than its own.
///
/// From one camera the pitch of a person and that of the camera look nearly the same, so the lifter's landmarks lean
/// with its vertical: what it knows is the pose relative to up. Over each shot the landmarks, and the starting poses
/// made of them, are turned about the pelvis by the smallest rotation from the lifter's mean up (EstimateUp()) to the
/// joint estimate with the lines of the picture (JoinVerticals()), or to the vertical that is given. Behind a camera
/// that moves these are directions of the scene, in which the landmarks are turned. LiftedFrame::up stays the lifter's
/// own. In further views so do the lifter's errors of pitch, which would turn the cameras against each other.
#pragma once

#include <vector>

#include "tracking/initialise/lifted_start.h"
#include "tracking/initialise/view_observations.h"
#include "tracking/problem/frame_layout.h"
#include "tracking/problem/track_input.h"

namespace bodyloom {

/// Focal length of the start, pixels, and standard deviation of its logarithm (0: known).
struct StartFocal {
  double px = 1, log_sigma = 0;
};

/// `states`: one a frame, camera axes. Returns the largest turn of a shot, radians: 0 where neither lines nor a ground
/// are known, and where the lifter's vertical is not clear.
double TurnToVertical(const TrackSequenceInput& input, const StartFocal& focal, const std::vector<char>& cut_before,
                      LiftedStart* lifted, std::vector<FrameState>* states);

/// The same for the further views that stand still, by the lines of their own pictures.
void TurnViewsToVertical(const TrackSequenceInput& input, const FrameLayout& layout,
                         std::vector<ViewObservations>* views);

}  // namespace bodyloom
