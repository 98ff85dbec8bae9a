// SPDX-License-Identifier: Apache-2.0
#include "geometry/biomechanics/hand_limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <vector>

#include "geometry/biomechanics/hand_prior.h"
#include "geometry/math/rotation.h"

namespace bodyloom::hand_limits_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;
using Rotations = std::vector<Matrix3d>;

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
Rotations Hand(const HandSkeleton& hand, double mcp, double pip, double dip, double radial) {
  Rotations rotations;
  for (int i = 0; i < kHandJoints; ++i) {
    Vector3d angles = Vector3d::Zero();
    if (i < 12) {
      angles[0] = kDegree * (i % 3 == 0 ? mcp : i % 3 == 1 ? pip : dip);
      angles[1] = i % 3 == 0 ? kDegree * radial : 0;
    }
    rotations.push_back(HandRotation(hand, i, angles));
  }
  return rotations;
}

Eigen::Matrix<double, kHandLimitRows, 1> LimitsOf(const HandSkeleton& hand, const Rotations& rotations,
                                                  const HandLimitOptions& options = {}) {
  Eigen::Matrix<double, kHandLimitRows, 1> residuals;
  HandLimitResiduals(hand, rotations, options, &residuals, nullptr);
  return residuals;
}

/// Central differences by right increments.
Eigen::MatrixXd Differences(Rotations rotations, const std::function<Eigen::VectorXd(const Rotations&)>& residuals) {
  Eigen::MatrixXd jacobian(residuals(rotations).size(), 3 * rotations.size());
  constexpr double kStep = 1e-6;
  for (size_t i = 0; i < rotations.size(); ++i) {
    const Matrix3d R = rotations[i];
    for (int c = 0; c < 3; ++c) {
      rotations[i] = R * RotationFromAxisAngle(kStep * Vector3d::Unit(c));
      const Eigen::VectorXd above = residuals(rotations);
      rotations[i] = R * RotationFromAxisAngle(-kStep * Vector3d::Unit(c));
      jacobian.col(static_cast<Eigen::Index>(3 * i) + c) = (above - residuals(rotations)) / (2 * kStep);
    }
    rotations[i] = R;
  }
  return jacobian;
}

Rotations RandomRotations(double spread, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, spread);
  Rotations rotations;
  for (int i = 0; i < kHandJoints; ++i) {
    Vector3d w;
    for (double& value : w) value = normal(random);
    rotations.push_back(RotationFromAxisAngle(w));
  }
  return rotations;
}

TEST(HandLimits, AnglesAndRotationsAreInverse) {
  const HandSkeleton hand = RandomHand();
  const Rotations rotations = RandomRotations(0.6, 2);
  for (int i = 0; i < kHandJoints; ++i) {
    EXPECT_LT((HandRotation(hand, i, HandAngles(hand, i, rotations[i])) - rotations[i]).norm(), 1e-12);
  }
  EXPECT_NEAR(HandAngles(hand, 4, Matrix3d::Identity())[0], hand.rest_flexion[4], 1e-15);
}

TEST(HandLimits, NothingInsideTheRanges) {
  const HandSkeleton hand = RandomHand();
  EXPECT_LT(LimitsOf(hand, Hand(hand, 0, 0, 0, 0)).norm(), 1e-9) << "a flat hand";
  EXPECT_LT(LimitsOf(hand, Hand(hand, 85, 105, 70, 0)).norm(), 1e-9) << "a fist";
  EXPECT_LT(LimitsOf(hand, Hand(hand, 10, 30, 20, -14)).norm(), 1e-9) << "spread";
}

TEST(HandLimits, ExcessOverTheNearestEnd) {
  const HandSkeleton hand = RandomHand();
  const HandLimitOptions options{.sigma_rad = 0.1, .coupling_sigma_rad = 0.5};
  const auto residuals = LimitsOf(hand, Hand(hand, -40, -18, -12, 0), options);
  for (int f = 0; f < 4; ++f) {
    EXPECT_NEAR(residuals[9 * f], -10 * kDegree / 0.1, 1e-9) << "MCP 10 degrees beyond -30";
    EXPECT_NEAR(residuals[9 * f + 3], -10 * kDegree / 0.1, 1e-9) << "PIP 10 degrees beyond -8";
    EXPECT_NEAR(residuals[9 * f + 6], -2 * kDegree / 0.1, 1e-9) << "DIP 2 degrees beyond -10";
    EXPECT_NEAR(residuals[45 + f], 0, 1e-9) << "-12 is two thirds of -18";
  }
  const auto sideways = LimitsOf(hand, Hand(hand, 0, 60, 10, 25), options);
  EXPECT_NEAR(sideways[10], 10 * kDegree / 0.1, 1e-9) << "the middle finger goes 15 degrees to the side";
  EXPECT_EQ(sideways[19], 0) << "the little finger 27";
  EXPECT_NEAR(sideways[45], -30 * kDegree / 0.5, 1e-9) << "DIP 10 where 40 goes with PIP 60";
}

TEST(HandLimits, DerivativesMatchDifferences) {
  const HandSkeleton hand = RandomHand();
  int compared = 0;
  for (const auto& rotations :
       {RandomRotations(0.9, 3), RandomRotations(0.02, 4), Hand(hand, -45, 120, 20, 30), Hand(hand, 0, 0, 0, 0)}) {
    Eigen::Matrix<double, kHandLimitRows, 1> residuals;
    Eigen::Matrix<double, kHandLimitRows, 3 * kHandJoints> jacobian;
    HandLimitResiduals(hand, rotations, {}, &residuals, &jacobian);
    EXPECT_EQ(residuals, LimitsOf(hand, rotations));
    const Eigen::MatrixXd expected = Differences(rotations, [&](const Rotations& r) { return LimitsOf(hand, r); });
    EXPECT_LT((jacobian - expected).cwiseAbs().maxCoeff(), 1e-6);
    compared += static_cast<int>((expected.array().abs() > 1e-3).count());
  }
  EXPECT_GT(compared, 200);
}

TEST(HandLimits, RefusesAnotherNumberOfJoints) {
  Eigen::Matrix<double, kHandLimitRows, 1> residuals;
  EXPECT_THROW(HandLimitResiduals(RandomHand(), Rotations(14, Matrix3d::Identity()), {}, &residuals, nullptr),
               std::invalid_argument);
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
    for (int other = 0; other < f; ++other) EXPECT_GT(covariance(pip, 3 * (3 * other + 1)), 0.5 * covariance(pip, pip));
  }
  // Closing the hand is its first component; it and few more hold most of the variance.
  EXPECT_GT(prior.sigma.head(12).squaredNorm() / prior.sigma.squaredNorm(), 0.9);
  for (int i = 0; i < kHandJoints; ++i) {
    const FingerJointRange& range = HandJointRanges()[i];
    EXPECT_GE(prior.mean[3 * i], range.flexion.low);
    EXPECT_LE(prior.mean[3 * i], range.flexion.high);
  }
}

TEST(HandPrior, ResidualsAreTheMahalanobisDistance) {
  const HandPrior& prior = BuiltinHandPrior();
  const HandSkeleton hand = RandomHand();
  const Eigen::MatrixXd covariance =
      prior.components * prior.sigma.cwiseAbs2().asDiagonal() * prior.components.transpose();
  const Rotations rotations = RandomRotations(0.5, 9);
  Eigen::Matrix<double, kHandAngles, 1> residuals, x;
  Eigen::Matrix<double, kHandAngles, kHandAngles> jacobian;
  HandPriorResiduals(prior, hand, rotations, &residuals, &jacobian);
  for (int i = 0; i < kHandJoints; ++i) x.segment<3>(3 * i) = HandAngles(hand, i, rotations[i]);
  const Eigen::VectorXd off = x - prior.mean;
  EXPECT_NEAR(residuals.squaredNorm() / off.dot(covariance.ldlt().solve(off)), 1, 1e-9);
  const Eigen::MatrixXd expected = Differences(rotations, [&](const Rotations& r) -> Eigen::VectorXd {
    Eigen::Matrix<double, kHandAngles, 1> values;
    HandPriorResiduals(prior, hand, r, &values, nullptr);
    return values;
  });
  EXPECT_LT((jacobian - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff(), 1e-7);
  Rotations mean;
  for (int i = 0; i < kHandJoints; ++i) mean.push_back(HandRotation(hand, i, prior.mean.segment<3>(3 * i)));
  HandPriorResiduals(prior, hand, mean, &residuals, nullptr);
  EXPECT_LT(residuals.norm(), 1e-9);
  EXPECT_THROW(HandPriorResiduals(prior, hand, Rotations(3, Matrix3d::Identity()), &residuals, nullptr),
               std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::hand_limits_test
