// SPDX-License-Identifier: Apache-2.0
#include "tracking/hands/hand_problem.h"

#include <ceres/crs_matrix.h>
#include <ceres/gradient_checker.h>
#include <ceres/problem.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <random>

#include "tests/support/synthetic_hands.h"

namespace bodyloom::hand_problem_test {
namespace {

using Eigen::Vector3d;

class HandCosts : public testing::Test {
 protected:
  HandCosts() {
    frame_.camera = MakePinhole(1000, 800, 900);
    frame_.camera.distortion[0] = 0.1;
    frame_.camera_from_elbow = RotationFromAxisAngle({0.4, -0.3, 2});
    frame_.forearm_axis = Vector3d(1, 0.2, -0.1).normalized();
    frame_.wrist = RotationFromAxisAngle({0.1, 0.5, -0.2});
    frame_.wrist_in_camera = {0.2, -0.3, 2};
    for (double& value : y_) value = normal_(random_);
  }
  /// Analytic derivatives against Ceres' numeric ones.
  void Check(const ceres::CostFunction& cost) {
    std::vector<const double*> blocks;
    for (size_t i = 0; i < cost.parameter_block_sizes().size(); ++i) blocks.push_back(blocks_.at(i));
    if (cost.parameter_block_sizes().size() == 1) blocks = {y_.data()};
    const ceres::GradientChecker checker(&cost, static_cast<std::vector<const ceres::Manifold*>*>(nullptr), {});
    ceres::GradientChecker::ProbeResults probe;
    EXPECT_TRUE(checker.Probe(blocks.data(), 1e-6, &probe)) << probe.error_log;
    Eigen::VectorXd without(cost.num_residuals()), with(cost.num_residuals());
    cost.Evaluate(blocks.data(), without.data(), nullptr);
    EXPECT_EQ(without, probe.residuals);
    double slopes = 0;
    for (const auto& jacobian : probe.jacobians) slopes += jacobian.norm();
    EXPECT_GT(slopes, 0);
  }
  std::mt19937 random_{5};
  std::normal_distribution<double> normal_;
  HandFrame frame_;
  HandKinematics hand_{BuiltinBodyWithHands(), FindHand(BuiltinBodyWithHands(), HandSide::kRight).value(), {}};
  std::array<double, kFingerCoordinates> y_{};
  std::array<double, 3> wrist_{0.3, -0.2, 0.1};
  std::array<double, 1> forearm_{0.4}, size_{0.05};
  std::array<double, 2> place_{0.01, -0.02};
  std::array<const double*, 5> blocks_{y_.data(), wrist_.data(), forearm_.data(), place_.data(), size_.data()};
};

TEST_F(HandCosts, DerivativesMatchDifferences) {
  for (int k = 1; k < kHandPoints; ++k) Check(HandPointCost(&hand_, &frame_, k, {400, 300}, 3));
  for (const auto& [from, to] : HandBones()) Check(HandBoneCost(&hand_, &frame_, from, to, {0, 0.6, 0.8}, 0.3));
  // Limits have kinks, which Ceres' wide differences cross.
  for (double& value : y_) value *= 5;
  const HandLimitCost limits(&hand_);
  Eigen::Matrix<double, kFingerCoordinates, kFingerCoordinates, Eigen::RowMajor> by_fingers;
  FingerCoordinates at, above, below;
  double* jacobian = by_fingers.data();
  const double* block = y_.data();
  ASSERT_TRUE(limits.Evaluate(&block, at.data(), &jacobian));
  for (int c = 0; c < kFingerCoordinates; ++c) {
    const double y = y_[c];
    y_[c] = y + 1e-6, limits.Evaluate(&block, above.data(), nullptr);
    y_[c] = y - 1e-6, limits.Evaluate(&block, below.data(), nullptr);
    y_[c] = y;
    EXPECT_LT(((above - below) / 2e-6 - by_fingers.col(c)).norm(), 1e-6);
  }
  EXPECT_GT((at.array() != 0).count(), 5) << "beyond the ranges";
}

TEST_F(HandCosts, NothingWhereAPointCannotBeProjected) {
  frame_.wrist_in_camera.z() = -1;
  Eigen::Vector2d residual(1, 1);
  Eigen::Matrix<double, 2, kFingerCoordinates, Eigen::RowMajor> by_fingers;
  by_fingers.setOnes();
  std::array<double*, 5> jacobians = {by_fingers.data(), nullptr, nullptr, nullptr, nullptr};
  EXPECT_TRUE(
      HandPointCost(&hand_, &frame_, 8, {400, 300}, 3).Evaluate(blocks_.data(), residual.data(), jacobians.data()));
  EXPECT_EQ(residual.norm() + by_fingers.norm(), 0);
}

TEST_F(HandCosts, PointsAreThoseOfTheMesh) {
  const BodyModel& body = BuiltinBodyWithHands();
  const HandSkeleton& hand = hand_.hand();
  const Eigen::Map<const FingerCoordinates> y(y_.data());
  const HandAngleVector angles = hand_.Angles(y);
  EXPECT_LT((hand_.CoordinatesOf(angles) - y).norm(), 1e-9);
  BodyPose pose;
  pose.rotations.assign(body.num_joints(), Eigen::Matrix3d::Identity());
  for (int j = 0; j < kHandJoints; ++j) pose.rotations[hand.joint[j]] = HandRotation(hand, j, angles.segment<3>(3 * j));
  const MatrixX3d joints = PoseSkeleton(body, body.RestJoints({}), pose).joints;
  for (int k = 1; k < kHandPoints; ++k) {
    const Vector3d point = hand_.Point(k, y, nullptr) + joints.row(hand.wrist).transpose();
    if (const int joint = HandJointAt(k); joint >= 0) {
      EXPECT_LT((point - joints.row(hand.joint[joint]).transpose()).norm(), 1e-12) << k;
    } else {
      const MatrixX3d tip = PoseLandmarks(body, {}, pose, {HandLandmarkNames(hand.side)[k]});
      EXPECT_LT((point - tip.row(0).transpose()).norm(), 0.004) << k << ": correctives move it a little";
    }
  }
}

TEST(SteadyPrior, IsTheProcessAtAnyDistances) {
  const std::vector<double> times = {0, 0.03, 0.1, 0.12, 0.5, 3};
  std::vector<double> values(times.size(), 0.0);
  std::vector<double*> blocks;
  for (double& value : values) blocks.push_back(&value);
  const auto covariance_of = [&](const std::vector<char>& cuts) -> Eigen::MatrixXd {
    ceres::Problem problem;
    AddSteadyPrior({.sigma = 2, .length_s = 0.4}, blocks, 1, times, cuts, &problem);
    ceres::CRSMatrix crs;
    ceres::Problem::EvaluateOptions options;
    options.parameter_blocks = blocks;
    EXPECT_TRUE(problem.Evaluate(options, nullptr, nullptr, nullptr, &crs));
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(crs.num_rows, crs.num_cols);
    for (int r = 0; r < crs.num_rows; ++r) {
      for (int at = crs.rows[r]; at < crs.rows[r + 1]; ++at) J(r, crs.cols[at]) = crs.values[at];
    }
    return (J.transpose() * J).inverse();
  };
  const Eigen::MatrixXd P = covariance_of({1, 0, 0, 0, 0, 0});
  const auto matern = [](double d) { return 4 * (1 + std::sqrt(3) * d / 0.4) * std::exp(-std::sqrt(3) * d / 0.4); };
  for (int t = 0; t < 6; ++t) {
    for (int u = std::max(0, t - 2); u <= t; ++u) EXPECT_NEAR(P(t, u), matern(times[t] - times[u]), 1e-9) << t << u;
  }
  const Eigen::MatrixXd cut = covariance_of({1, 0, 0, 1, 0, 0});
  EXPECT_NEAR(cut(3, 2), 0, 1e-12);
  EXPECT_NEAR(cut(3, 3), 4, 1e-9);
  EXPECT_NEAR(cut(4, 2), 0, 1e-12);
}

TEST(HandProblem, NamesItsBlocks) {
  SyntheticHands made = MakeSyntheticHands({.frames = 4});
  made.track.motion.poses.row(1).setConstant(std::nan(""));
  const BodyModel& body = BuiltinBodyWithHands();
  HandProblem problem(body, FindHand(body, HandSide::kLeft).value(), made.track, made.seen, {}, {});
  EXPECT_EQ(problem.fingers(1), nullptr);
  EXPECT_EQ(problem.NameOf(problem.fingers(2)), "fingers of l_wrist, frame 2");
  EXPECT_EQ(problem.NameOf(problem.place(3)), "place of l_wrist, frame 3");
  EXPECT_EQ(problem.NameOf(problem.log_size()), "log size of l_wrist");
  EXPECT_EQ(problem.NameOf(nullptr), "");
  EXPECT_EQ(problem.problem().NumParameterBlocks(), 3 * 4 + 1);
  // A block that is held stays.
  problem.problem().SetParameterBlockConstant(problem.log_size());
  EXPECT_EQ(problem.Solve(20), "");
  EXPECT_EQ(*problem.log_size(), 0);
  EXPECT_NE(problem.fingers(2)[0], 0);
}

TEST(HandProblem, SigmaIsThatOfTheWholeMatrix) {
  SyntheticHands made = MakeSyntheticHands({.pose = "pinch", .frames = 5});
  const BodyModel& body = BuiltinBodyWithHands();
  HandProblem problem(body, FindHand(body, HandSide::kRight).value(), made.track, made.seen, {}, {});
  ASSERT_EQ(problem.Solve(20), "");
  const HandProblem::Sigma sigma = problem.FindSigma();
  ceres::Problem::EvaluateOptions options;
  for (int t = 0; t < 5; ++t) options.parameter_blocks.push_back(problem.fingers(t));
  for (int t = 0; t < 5; ++t) {
    for (double* block : {problem.wrist(t), problem.forearm(t), problem.place(t)})
      options.parameter_blocks.push_back(block);
  }
  options.parameter_blocks.push_back(problem.log_size());
  ceres::CRSMatrix crs;
  ASSERT_TRUE(problem.problem().Evaluate(options, nullptr, nullptr, nullptr, &crs));
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(crs.num_rows, crs.num_cols);
  for (int r = 0; r < crs.num_rows; ++r) {
    for (int at = crs.rows[r]; at < crs.rows[r + 1]; ++at) J(r, crs.cols[at]) = crs.values[at];
  }
  const Eigen::MatrixXd P = (J.transpose() * J).inverse();
  const auto& L = problem.kinematics().by_coordinates();
  for (int t = 0; t < 5; ++t) {
    const Eigen::MatrixXd of_frame = P.block<kFingerCoordinates, kFingerCoordinates>(20 * t, 20 * t);
    const Eigen::VectorXd expected = (L * of_frame * L.transpose()).diagonal().cwiseSqrt();
    EXPECT_LT((sigma.angles.row(t).transpose() - expected).norm(), 1e-6 * expected.norm());
  }
}

}  // namespace
}  // namespace bodyloom::hand_problem_test
