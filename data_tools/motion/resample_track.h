// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geometry/scene/track.h"

namespace bodyloom {

/// Resamples a track at t0 + k/fps, t0 its first timestamp. Rotations along the shortest arc, positions and
/// weak-perspective cameras linearly, the status of the nearer frame; a frame at the same instant is copied.
///
/// Gaps are not interpolated: more than 1.5 times the longer of both rates' steps from one frame with a result to the
/// next. In such a gap the result has lost frames if the track does, and no frames if the track has none (its
/// timestamps jump).
///
/// Joints, landmarks and their sigma are dropped. A track of one frame is returned unchanged. Throws
/// std::invalid_argument for a rate outside (0, 1e5), timestamps that do not increase and tracks without a frame.
Track ResampleTrack(const Track& track, double fps);

/// The track played `speed` times as fast (0.5: twice as long), at `fps` frames a second (0: the rate that it had):
/// frame t is the track's state at t0 + speed · t/fps, interpolated as in ResampleTrack. Throws std::invalid_argument
/// for a speed outside [0.05, 20], and unless every frame has a result and timestamps are regular (FrameRate,
/// data_tools/motion/motion_tools.h).
Track PlayedAtSpeed(const Track& track, double speed, double fps = 0);

}  // namespace bodyloom
