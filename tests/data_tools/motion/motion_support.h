// SPDX-License-Identifier: Apache-2.0
/// Synthetic motions of SMPL's 24 joints for tests of the processing of recordings.
#pragma once

#include <cmath>

#include "data_tools/motion/motion_floor.h"
#include "data_tools/motion/smpl_rest.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// T-pose at rest, soles on y = 0.
inline Motion StandingMotion(double fps, double seconds) {
  Motion motion;
  motion.body = "smpl";
  motion.up = Motion::Up::kY;
  const int T = static_cast<int>(std::lround(seconds * fps)) + 1;
  motion.poses = RowMatrixXd::Zero(T, 72);
  motion.trans = MatrixX3d::Zero(T, 3);
  motion.trans.col(1).setConstant(-LowestPoint(SmplRestJoints()));
  for (int t = 0; t < T; ++t) motion.timestamps.push_back(t / fps);
  return motion;
}

/// A walk of one step per second along z: legs swing from the hips, the knee of the swing leg bends, and the stance
/// foot, the left one first, stays in place.
inline Motion WalkingMotion(double fps, double seconds) {
  Motion motion = StandingMotion(fps, seconds);
  Eigen::RowVector3d bearing = Eigen::RowVector3d::Zero();
  int side_before = -1;
  for (int t = 0; t < motion.num_frames(); ++t) {
    const double phase = motion.timestamps[t];
    const int side = static_cast<int>(std::floor(phase)) % 2;  // bears: 0 left, 1 right
    const double s = phase - std::floor(phase);
    const double swing = 0.35 * std::cos(M_PI * s);  // the bearing leg from the front to the back
    motion.poses(t, 3 * (1 + side)) = -swing;
    motion.poses(t, 3 * (2 - side)) = swing;
    motion.poses(t, 3 * (5 - side)) = 0.9 * std::sin(M_PI * s);
    motion.poses(t, 3 * (7 + side)) = swing;  // the bearing foot stays flat
    const MatrixX3d joints = PoseSmplJoints(motion.poses.row(t).transpose(), Eigen::Vector3d::Zero());
    const Eigen::RowVector3d toe = joints.row(10 + side);
    if (side != side_before) {
      // The new bearing foot touches down where it has been carried.
      bearing = t == 0 ? toe : Eigen::RowVector3d(toe + motion.trans.row(t - 1));
      bearing.y() = 0.01;
      side_before = side;
    }
    motion.trans.row(t) = bearing - toe;
  }
  return motion;
}

}  // namespace bodyloom
