// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/skeleton_motion.h"

#include <algorithm>

#include "geometry/base/check.h"

namespace bodyloom {

int SkeletonMotion::FindJoint(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

MatrixX3d RestPositions(const SkeletonMotion& motion) {
  MatrixX3d positions = MatrixX3d::Zero(motion.num_joints(), 3);
  for (int j = 1; j < motion.num_joints(); ++j)
    positions.row(j) = positions.row(motion.parents[j]) + motion.offsets.row(j);
  return positions;
}

SkeletonFrame PoseSkeletonFrame(const SkeletonMotion& motion, int frame) {
  BODYLOOM_CHECK(frame >= 0 && frame < motion.num_frames(), "frame ", frame, " of ", motion.num_frames());
  const int J = motion.num_joints();
  SkeletonFrame posed;
  posed.rotations.resize(J);
  posed.positions.resize(J, 3);
  const Eigen::Matrix3d* local = motion.rotations.data() + size_t(frame) * J;
  posed.rotations[0] = local[0];
  posed.positions.row(0) = motion.root_positions.row(frame);
  for (int j = 1; j < J; ++j) {
    const int p = motion.parents[j];
    posed.rotations[j] = posed.rotations[p] * local[j];
    posed.positions.row(j) = posed.positions.row(p) + motion.offsets.row(j) * posed.rotations[p].transpose();
  }
  return posed;
}

std::vector<double> RegularTimestamps(int num_frames, double seconds_per_frame) {
  std::vector<double> timestamps(num_frames);
  for (int t = 0; t < num_frames; ++t) timestamps[t] = t * seconds_per_frame;
  return timestamps;
}

}  // namespace bodyloom
