// SPDX-License-Identifier: Apache-2.0
/// Basic operations on motions, shared by readers, writers and generators.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/scene/track.h"

namespace bodyloom {

/// Rotates the world of a motion (y up, z up, or camera with y down) to one with `up` (kY or kZ); a camera is assumed
/// level. The root rotates about the pelvis joint, which is not the origin: with R the rotation and J0 the body's rest
/// pelvis, θ_root ← R·θ_root and trans ← R(J0 + trans) − J0.
Motion ChangeUp(const Motion& motion, Motion::Up up, const Eigen::Vector3d& rest_pelvis);

/// Resamples a motion at t0 + k/fps: rotations along the shortest arc, translations linearly. The last instant is kept
/// within rounding. A motion of one frame is returned unchanged. Throws std::invalid_argument for fps that is not
/// positive.
Motion ResampleMotion(const Motion& motion, double fps);

/// Sets frame `to` of `out` to `motion` between its frames `before` and `after`, at fraction `share` in [0, 1]:
/// rotations along the shortest arc, translations linearly. Sizes are the caller's responsibility.
void InterpolateFrame(const Motion& motion, int before, int after, double share, int to, Motion* out);

/// Returns frames first, first + step, … (count of them). Throws std::invalid_argument when the motion does not have
/// them.
Motion TakeFrames(const Motion& motion, int first, int count, int step = 1);

/// Concatenates motions `gap_s` seconds apart, so that they are recognised as separate; each is moved along the floor
/// so that its root is on average above the origin, and vertically to a common standing height (the root's 80 %
/// quantile). Throws std::invalid_argument when there are none, or they differ in joints, body or up axis.
Motion JoinMotions(const std::vector<Motion>& motions, double gap_s);

/// Frames per second of a motion with regular timestamps; 0 if its steps differ by more than 1 % (a gap) or it has
/// fewer than two frames.
double FrameRate(const Motion& motion);

/// Frames per second between a motion's gaps: of the steps that are at most 1.5 times the median one, their number over
/// their sum. 0 with fewer than two frames.
double FrameRateWithoutGaps(const Motion& motion);

}  // namespace bodyloom
