// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/skeleton_gradient.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "geometry/math/rotation.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::skeleton_gradient_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A pose and a linear loss on its bones.
struct BoneLoss {
  const BodyModel& model = ToyBody();
  MatrixX3d rest = model.RestJoints(Eigen::VectorXd::Constant(2, 0.5));
  BodyPose pose = RandomPose(model, 3, 1.5, 2.5);
  std::vector<Matrix3d> by_rotations;
  MatrixX3d by_joints;

  BoneLoss() {
    std::mt19937 generator(5);
    const auto uniform = [&] { return generator() / 2147483648.0 - 1; };
    by_joints.resize(model.num_joints(), 3);
    for (int j = 0; j < model.num_joints(); ++j) {
      Matrix3d by_rotation;
      for (double& v : by_rotation.reshaped()) v = uniform();
      by_rotations.push_back(by_rotation);
      for (int c = 0; c < 3; ++c) by_joints(j, c) = uniform();
    }
  }
  [[nodiscard]] PosedSkeleton Skeleton(const BodyPose& of) const { return PoseSkeleton(model, rest, of); }
  [[nodiscard]] double At(const BodyPose& of) const {
    const PosedSkeleton skeleton = Skeleton(of);
    double loss = by_joints.cwiseProduct(skeleton.joints).sum();
    for (int j = 0; j < model.num_joints(); ++j) {
      loss += by_rotations[j].cwiseProduct(skeleton.world_rotations[j]).sum();
    }
    return loss;
  }
  /// The pose with number k of the 3J + 3 moved.
  [[nodiscard]] BodyPose Moved(int k, double by) const {
    BodyPose moved = pose;
    const int j = k / 3;
    const Vector3d step = by * Vector3d::Unit(k % 3);
    if (j < model.num_joints()) {
      moved.rotations[j] = moved.rotations[j] * RotationFromAxisAngle(step);
    } else {
      moved.trans += step;
    }
    return moved;
  }
};

TEST(SkeletonBackward, IsADifference) {
  const BoneLoss loss;
  const SkeletonGradient gradient =
      SkeletonBackward(loss.model.parents(), loss.Skeleton(loss.pose), loss.by_rotations, loss.by_joints);
  const int J = loss.model.num_joints();
  int compared = 0;
  for (int k = 0; k < 3 * J + 3; ++k) {
    const double step = 1e-5, difference = (loss.At(loss.Moved(k, step)) - loss.At(loss.Moved(k, -step))) / (2 * step);
    const double ours = k < 3 * J ? gradient.by_turns(k / 3, k % 3) : gradient.by_trans[k % 3];
    EXPECT_NEAR(ours, difference, 1e-8 * (1 + std::abs(difference))) << k;
    compared += static_cast<int>(std::abs(difference) > 0.05);
  }
  EXPECT_GT(compared, 2 * J);
}

TEST(SkeletonBackward, RefusesTablesOfOtherSizes) {
  const BoneLoss loss;
  const PosedSkeleton skeleton = loss.Skeleton(loss.pose);
  const MatrixX3d fewer = loss.by_joints.topRows(loss.model.num_joints() - 1);
  EXPECT_THROW(SkeletonBackward(loss.model.parents(), skeleton, loss.by_rotations, fewer), std::invalid_argument);
  EXPECT_THROW(SkeletonBackward(loss.model.parents(), skeleton, std::span(loss.by_rotations).first(2), loss.by_joints),
               std::invalid_argument);
}

TEST(JointJacobian, IsADifference) {
  const BoneLoss loss;
  const int J = loss.model.num_joints();
  const Eigen::MatrixXd jacobian = JointJacobian(loss.model.parents(), loss.Skeleton(loss.pose));
  ASSERT_EQ(jacobian.rows(), 3 * J);
  ASSERT_EQ(jacobian.cols(), 3 * J + 3);
  int compared = 0;
  for (int k = 0; k < 3 * J + 3; ++k) {
    const double step = 1e-5;
    const MatrixX3d difference =
        (loss.Skeleton(loss.Moved(k, step)).joints - loss.Skeleton(loss.Moved(k, -step)).joints) / (2 * step);
    for (int d = 0; d < J; ++d) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(jacobian(3 * d + c, k), difference(d, c), 1e-8) << d << " " << k;
        compared += static_cast<int>(std::abs(difference(d, c)) > 0.01);
      }
    }
  }
  EXPECT_GT(compared, 10 * J);
}

}  // namespace
}  // namespace bodyloom::skeleton_gradient_test
