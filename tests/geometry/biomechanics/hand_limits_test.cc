// SPDX-License-Identifier: Apache-2.0
#include "geometry/biomechanics/hand_limits.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/biomechanics/hand_prior.h"
#include "geometry/math/rotation.h"

namespace bodyloom::hand_limits_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;
/// A hand whose joints have axes of their own.
HandSkeleton RandomHand() {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  HandSkeleton hand;
  for (int i = 0; i < kHandJoints; ++i) {
    hand.joint[i] = 22 + i;
    hand.axes[i] = RotationFromAxisAngle({normal(random), normal(random), normal(random)});
    hand.axes[i].col(2) *= -1;  // as of every hand: left-handed, for components that mirror
    hand.rest_flexion[i] = 0.1 * normal(random);
  }
  return hand;
}

/// The same angles in degrees for every finger; the thumb in the middle of its ranges.
HandAngleVector Hand(double mcp, double pip, double dip, double radial) {
  HandAngleVector angles = HandAngleVector::Zero();
  for (int i = 0; i < 12; ++i) {
    angles[3 * i] = kDegree * (i % 3 == 0 ? mcp : i % 3 == 1 ? pip : dip);
    angles[3 * i + 1] = i % 3 == 0 ? kDegree * radial : 0;
  }
  return angles;
}

HandAngleVector LimitsOf(const HandAngleVector& angles) {
  HandAngleVector residuals;
  HandLimitResiduals(angles, &residuals, nullptr);
  return residuals;
}

TEST(HandLimits, AnglesAndRotationsAreInverse) {
  const HandSkeleton hand = RandomHand();
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0, 0.6);
  for (int i = 0; i < kHandJoints; ++i) {
    Vector3d w;
    for (double& value : w) value = normal(random);
    const Matrix3d R = RotationFromAxisAngle(w);
    EXPECT_LT((HandRotation(hand, i, HandAngles(hand, i, R)) - R).norm(), 1e-12);
  }
  EXPECT_NEAR(HandAngles(hand, 4, Matrix3d::Identity())[0], hand.rest_flexion[4], 1e-15);
}

TEST(HandLimits, NothingInsideTheRanges) {
  EXPECT_EQ(LimitsOf(Hand(0, 0, 0, 0)).norm(), 0) << "a flat hand";
  EXPECT_EQ(LimitsOf(Hand(85, 105, 70, 0)).norm(), 0) << "a fist";
  EXPECT_EQ(LimitsOf(Hand(10, 30, 20, -14)).norm(), 0) << "spread";
}

TEST(HandLimits, ExcessOverTheNearestEnd) {
  const HandAngleVector residuals = LimitsOf(Hand(-40, -18, -12, 0));
  for (int f = 0; f < 4; ++f) {
    EXPECT_NEAR(residuals[9 * f], -10 * kDegree / 0.05, 1e-9) << "MCP 10 degrees beyond -30";
    EXPECT_NEAR(residuals[9 * f + 3], -10 * kDegree / 0.05, 1e-9) << "PIP 10 degrees beyond -8";
    EXPECT_NEAR(residuals[9 * f + 6], -2 * kDegree / 0.05, 1e-9) << "DIP 2 degrees beyond -10";
  }
  const HandAngleVector sideways = LimitsOf(Hand(0, 60, 10, 25));
  EXPECT_NEAR(sideways[10], 10 * kDegree / 0.05, 1e-9) << "the middle finger goes 15 degrees to the side";
  EXPECT_EQ(sideways[19], 0) << "the little finger 27";
}

TEST(HandLimits, SlopesMatchDifferences) {
  const HandAngleVector angles = Hand(-45, 120, 20, 30);
  HandAngleVector residuals, slopes;
  HandLimitResiduals(angles, &residuals, &slopes);
  EXPECT_EQ(residuals, LimitsOf(angles));
  int compared = 0;
  for (int k = 0; k < kHandAngles; ++k) {
    HandAngleVector above = angles, below = angles;
    above[k] += 1e-6, below[k] -= 1e-6;
    const HandAngleVector by_angle = (LimitsOf(above) - LimitsOf(below)) / 2e-6;
    EXPECT_NEAR(by_angle[k], slopes[k], 1e-6);
    EXPECT_NEAR(by_angle.sum(), by_angle[k], 1e-6) << "of no other angle";
    compared += slopes[k] > 0 ? 1 : 0;
  }
  EXPECT_GT(compared, 10);
}

TEST(HandPrior, IsHalfClosedWithCoupledJoints) {
  const HandPrior& prior = BuiltinHandPrior();
  EXPECT_EQ(&prior, &BuiltinHandPrior());
  const Eigen::MatrixXd covariance =
      prior.components * prior.sigma.cwiseAbs2().asDiagonal() * prior.components.transpose();
  EXPECT_LT((prior.components.transpose() * prior.components - Eigen::MatrixXd::Identity(45, 45)).norm(), 1e-9);
  for (int k = 1; k < kHandAngles; ++k) EXPECT_LE(prior.sigma[k], prior.sigma[k - 1]);
  for (int f = 0; f < 4; ++f) {
    const int pip = 3 * (3 * f + 1), dip = 3 * (3 * f + 2);
    EXPECT_NEAR(prior.mean[pip], 52.5 * kDegree, 2 * kDegree);  // the middle of 5 to 100
    EXPECT_NEAR(prior.mean[dip], kDipByPip * prior.mean[pip], 2 * kDegree);
    EXPECT_GT(covariance(pip, dip) / std::sqrt(covariance(pip, pip) * covariance(dip, dip)), 0.7);
    for (int other = 0; other < f; ++other) EXPECT_GT(covariance(pip, 3 * (3 * other + 1)), 0.1 * covariance(pip, pip));
  }
  // Closing the hand is its first component; it and few more hold most of the variance.
  EXPECT_GT(prior.sigma.head(16).squaredNorm() / prior.sigma.squaredNorm(), 0.9);
  for (int i = 0; i < kHandJoints; ++i) {
    const FingerJointRange& range = HandJointRanges()[i];
    EXPECT_GE(prior.mean[3 * i], range.flexion.low);
    EXPECT_LE(prior.mean[3 * i], range.flexion.high);
  }
}

}  // namespace
}  // namespace bodyloom::hand_limits_test
