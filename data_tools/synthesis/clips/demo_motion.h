// SPDX-License-Identifier: Apache-2.0
/// A short procedural motion: a person stands, walks up in a curve, turns to the viewer, waves, kicks and stands again.
/// For the demo and for tests that need realistic motion without a data set.
///
/// Footsteps (position and time) are planned and the legs follow by two-bone inverse kinematics, so feet do not slide;
/// arms, spine and head follow keyed curves. All curves are smooth to the second derivative.
#pragma once

#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

inline constexpr double kDemoMotionSeconds = 6.0;

/// Returns `num_frames` frames at `fps`, from t = 0. World frame: y up, floor at y = 0, metres; the person ends near
/// the origin facing +z. The motion lasts kDemoMotionSeconds and begins and ends at rest; longer clips play it forwards
/// and backwards in turn. The body is needed for its limb lengths and must have SMPL's joint tree (at least 24 joints,
/// mean shape used); its height may be anything. Throws std::invalid_argument otherwise, or when num_frames < 1 or fps
/// is not positive.
Motion DemoMotion(const BodyModel& body, int num_frames, double fps);

}  // namespace bodyloom
