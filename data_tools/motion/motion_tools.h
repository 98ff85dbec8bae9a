// SPDX-License-Identifier: Apache-2.0
/// Small operations on motions that readers, writers and generators share.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/scene/track.h"

namespace bodyloom {

/// Turns the world of a motion (y up, z up, or camera with y down) into one with `up` (kY or kZ); a camera's world is
/// taken as level. The root turns about the pelvis joint, which is not the origin: with R the turn and J0 the body's
/// rest pelvis, θ_root ← R·θ_root and trans ← R(J0 + trans) − J0.
Motion ChangeUp(const Motion& motion, Motion::Up up, const Eigen::Vector3d& rest_pelvis);

/// The same motion at t0 + k/fps: rotations along the shortest arc, translations linearly. The last instant is kept
/// within rounding. A motion of one frame stays as it is. Throws std::invalid_argument for fps that is not positive.
Motion ResampleMotion(const Motion& motion, double fps);

/// Frame `to` of `out`: `motion` between its frames `before` and `after`, `share` in [0, 1] of the way: rotations along
/// the shortest arc, the place linearly. Sizes are the caller's responsibility.
void InterpolateFrame(const Motion& motion, int before, int after, double share, int to, Motion* out);

/// Frames first, first + step, … (count of them) as they are. Throws std::invalid_argument when the motion does not
/// have them.
Motion TakeFrames(const Motion& motion, int first, int count, int step = 1);

/// One motion after the other, `gap_s` seconds apart, so that nothing takes them for one movement; each is moved along
/// the floor so that its root is above the origin on the average, and up or down so that people stand at one height
/// (the root's 80 % quantile). Throws std::invalid_argument when there are none, or they differ in joints, body or up
/// axis.
Motion JoinMotions(const std::vector<Motion>& motions, double gap_s);

/// Frames per second of a motion with a regular clock; 0 when its steps differ by more than 1 % (a gap) or it has fewer
/// than two frames.
double FrameRate(const Motion& motion);

/// Frames per second between a motion's gaps: of the steps that are at most 1.5 times the median one, their number over
/// their sum. 0 with fewer than two frames.
double FrameRateWithoutGaps(const Motion& motion);

}  // namespace bodyloom
