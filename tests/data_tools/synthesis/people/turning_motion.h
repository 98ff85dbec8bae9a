// SPDX-License-Identifier: Apache-2.0
/// A turning motion for tests of cloth.
#pragma once

#include "geometry/scene/track.h"

namespace bodyloom {

/// Standing with the arms down, turned about the vertical by angle(t).
template <typename Angle>
Motion Turning(int frames, double fps, const Angle& angle) {
  Motion motion;
  motion.body = "bodyloom";
  motion.poses = RowMatrixXd::Zero(frames, 72);
  motion.trans = MatrixX3d::Zero(frames, 3);
  for (int t = 0; t < frames; ++t) {
    motion.poses(t, 3 * 16 + 2) = -1.1, motion.poses(t, 3 * 17 + 2) = 1.1;
    motion.poses(t, 1) = angle(t / fps);
    motion.timestamps.push_back(t / fps);
  }
  return motion;
}

}  // namespace bodyloom
