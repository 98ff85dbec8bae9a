// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/skeleton_gradient.h"

#include <Eigen/Geometry>

#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::RowVector3d;
using Eigen::Vector3d;

SkeletonGradient SkeletonBackward(std::span<const int> parents, const PosedSkeleton& skeleton,
                                  std::span<const Matrix3d> by_rotations, const MatrixX3d& by_joints) {
  const auto J = static_cast<int>(parents.size());
  BODYLOOM_CHECK(static_cast<int>(skeleton.world_rotations.size()) == J && skeleton.joints.rows() == J &&
                     static_cast<int>(by_rotations.size()) == J && by_joints.rows() == J,
                 "skeleton gradient: ", J, " parents for ", skeleton.joints.rows(), " joints, derivatives by ",
                 by_rotations.size(), " rotations and ", by_joints.rows(), " places");
  MatrixX3d force = by_joints;
  MatrixX3d torque(J, 3);
  for (int j = 0; j < J; ++j) {
    Vector3d sum = Vector3d::Zero();
    for (int c = 0; c < 3; ++c) sum += skeleton.world_rotations[j].col(c).cross(by_rotations[j].col(c));
    torque.row(j) = sum.transpose();
  }
  SkeletonGradient gradient;
  gradient.by_turns.resize(J, 3);
  for (int j = J - 1; j >= 0; --j) {  // parents come before their children
    gradient.by_turns.row(j) = torque.row(j) * skeleton.world_rotations[j];
    const int p = parents[j];
    if (p < 0) continue;
    const RowVector3d arm = skeleton.joints.row(j) - skeleton.joints.row(p), pull = force.row(j);
    torque.row(p) += torque.row(j) + arm.cross(pull);
    force.row(p) += pull;
  }
  gradient.by_trans = force.row(0).transpose();
  return gradient;
}

Eigen::MatrixXd JointJacobian(std::span<const int> parents, const PosedSkeleton& skeleton) {
  const auto J = static_cast<int>(parents.size());
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(3 * J, 3 * J + 3);
  for (int d = 0; d < J; ++d) {
    for (int j = parents[d]; j >= 0; j = parents[j]) {
      const Vector3d arm = (skeleton.joints.row(d) - skeleton.joints.row(j)).transpose();
      jacobian.block<3, 3>(3 * d, 3 * j) = -Skew(arm) * skeleton.world_rotations[j];
    }
    jacobian.block<3, 3>(3 * d, 3 * J).setIdentity();
  }
  return jacobian;
}

}  // namespace bodyloom
