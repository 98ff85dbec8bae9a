// SPDX-License-Identifier: Apache-2.0
/// A motion of an arbitrary skeleton, as in capture files: joint rotations of each frame, in the file's units and axes.
///
/// The rest pose has every joint frame parallel to the file's axes: joint j is at Σ offsets along its chain. In frame t
///   world_rotation_j = world_rotation_parent · rotation_j,
///   world_position_j = world_position_parent + world_rotation_parent · offset_j.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

struct SkeletonMotion {
  std::vector<std::string> names;          ///< J; ends of chains that carry no rotation are called "<parent>_end"
  std::vector<int> parents;                ///< J; parents[0] = −1, parents[j] < j
  MatrixX3d offsets;                       ///< J×3 from the parent's joint in the rest pose, file units
  std::vector<Eigen::Matrix3d> rotations;  ///< T·J, frame-major, relative to the parent
  MatrixX3d root_positions;                ///< T×3, file units
  std::vector<double> timestamps;          ///< T seconds

  [[nodiscard]] int num_joints() const { return static_cast<int>(parents.size()); }
  [[nodiscard]] int num_frames() const { return static_cast<int>(timestamps.size()); }
  /// Returns the index of an exact name, −1 when absent.
  [[nodiscard]] int FindJoint(const std::string& name) const;
};

/// Maximum number of joint rotations (frames × joints) that readers accept: 2 GB, two hours of 31 joints at 120 Hz.
inline constexpr size_t kMaxRotations = 30'000'000;

/// J×3 joint positions of the rest pose, root at the origin.
MatrixX3d RestPositions(const SkeletonMotion& motion);

/// World rotations and positions of one frame.
struct SkeletonFrame {
  std::vector<Eigen::Matrix3d> rotations;  ///< J: world from joint
  MatrixX3d positions;                     ///< J×3
};
SkeletonFrame PoseSkeletonFrame(const SkeletonMotion& motion, int frame);

/// T timestamps k/fps.
std::vector<double> RegularTimestamps(int num_frames, double seconds_per_frame);

}  // namespace bodyloom
