// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geometry/scene/track.h"

namespace bodyloom {

/// The track at another frame rate: its state at t0 + k/fps by its own timestamps, t0 its first. Rotations along the
/// shortest arc, places and weak-perspective cameras linearly, the status of the nearer frame; a frame at that very
/// instant as it is.
///
/// Nothing is interpolated across a gap, which is more than 1.5 times the longer of both rates' steps from one frame
/// with a result to the next. Where the track has lost frames in such a gap, so has the result; where it has none (its
/// clock jumps), neither has the result.
///
/// Joints, landmarks and their sigma are not carried along. A track of one frame stays as it is. Throws
/// std::invalid_argument for a rate outside (0, 1e5), timestamps that do not grow and tracks without a frame.
Track ResampleTrack(const Track& track, double fps);

/// The track played `speed` times as fast (0.5: twice as long), at `fps` frames a second (0: the rate that it had):
/// frame t shows what the track shows at its time t0 + speed · t/fps (ResampleTrack,
/// data_tools/motion/resample_track.h, which says what is interpolated and what is not carried along). Throws
/// std::invalid_argument for a speed outside [0.05, 20], and unless every frame has a result and the clock is regular
/// (FrameRate, data_tools/motion/motion_tools.h).
Track PlayedAtSpeed(const Track& track, double speed, double fps = 0);

}  // namespace bodyloom
