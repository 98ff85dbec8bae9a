// SPDX-License-Identifier: Apache-2.0
#include "tracking/clip/uncertainty.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <random>

#include "data_tools/body/builtin_body.h"
#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "tests/support/dense_chain.h"
#include "tests/support/sequence_scene.h"
#include "tracking/lifter/lifter_input.h"
#include "tracking/solvers/solve_sequence.h"
#include "tracking/terms/dense/dense.h"
#include "tracking/terms/initialiser.h"
#include "tracking/terms/joint_limits.h"
#include "tracking/terms/landmarks.h"
#include "tracking/terms/straight_knees.h"
#include "tracking/terms/upright.h"

namespace bodyloom::uncertainty_test {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

VectorXd JointPositions(const FrameLayout& layout, const FrameState& state, const VectorXd& betas) {
  Kinematics kinematics;
  Vector3d trans = state.translation;
  if (layout.knowledge == CameraKnowledge::kWeak) trans = {state.translation[1], state.translation[2], 0};
  kinematics.Set(*layout.model, betas, state.rotations, trans, false);
  VectorXd joints(3 * layout.model->num_joints());
  for (int j = 0; j < layout.model->num_joints(); ++j) joints.segment<3>(3 * j) = kinematics.p[j];
  return joints;
}

class UncertaintyOf : public testing::TestWithParam<CameraKnowledge> {};

TEST_P(UncertaintyOf, EqualsTheDenseInverseOfTheNormalMatrix) {
  for (const bool shape : {true, false}) {
    SequenceSceneOptions options;
    options.frames = 7;
    options.knowledge = GetParam();
    const auto scene = MakeSequenceScene(options);
    SequenceProblem problem = scene->problem;
    problem.cut_before[5] = 1;
    if (!shape) {
      problem.layout = FrameLayout::Make(scene->body, GetParam(), problem.layout.camera, AllJoints(scene->body), 0);
      problem.betas.resize(0);
    }
    ChainProblem chain(problem, false, false, 1);
    ChainPoint x(problem.states, problem);
    chain.Linearise(x);
    MatrixXd H;
    VectorXd g;
    DenseSystem(chain, 7, &H, &g);
    const int n = chain.frame_size(), s = chain.shared_size(), J = scene->body.num_joints();
    H.diagonal().head(7 * n).array() += 1e-6;
    const MatrixXd covariance = H.llt().solve(MatrixXd::Identity(H.rows(), H.rows()));
    const PositionSigma sigma = PositionSigmaOf(problem, 2);
    // Derivatives of the joints by differences.
    constexpr double kStep = 1e-5;
    MatrixXd D = MatrixXd::Zero(7 * 3 * J, H.rows());
    for (int i = 0; i < H.rows(); ++i) {
      VectorXd step = VectorXd::Zero(7 * n), shared = VectorXd::Zero(s);
      (i < 7 * n ? step[i] : shared[i - 7 * n]) = kStep;
      ChainPoint a, b;
      chain.Plus(x, step, shared, &a);
      chain.Plus(x, -step, -shared, &b);
      for (int t = 0; t < 7; ++t) {
        D.block(t * 3 * J, i, 3 * J, 1) = (JointPositions(problem.layout, a.states[t], a.betas) -
                                           JointPositions(problem.layout, b.states[t], b.betas)) /
                                          (2 * kStep);
      }
    }
    const std::array<int, 2> hip = HipJoints(scene->body);
    const auto spread = [&](const MatrixXd& rows) {
      return std::sqrt((rows * covariance).cwiseProduct(rows).sum() / 3);
    };
    for (int t = 0; t < 7; ++t) {
      const MatrixXd hips = 0.5 * (D.middleRows<3>(3 * (t * J + hip[0])) + D.middleRows<3>(3 * (t * J + hip[1])));
      EXPECT_NEAR(sigma.hips[t], spread(hips), 1e-7 * sigma.hips[t]) << t;
      for (int j = 0; j < J; ++j) {
        const double expected = spread(D.middleRows<3>(3 * (t * J + j)) - hips);
        EXPECT_NEAR(sigma.joints(t, j), expected, 1e-7 * expected + 1e-10) << t << " " << j;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, UncertaintyOf,
                         testing::Values(CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal,
                                         CameraKnowledge::kWeak));

// Everything is linear, and everything that is measured or assumed is drawn from the distribution of the cost:
// accelerations, and positions of which some are missing. Then the spread of the error is what is reported, in every
// frame.
TEST(Uncertainty, SpreadOfTheErrorsOfALinearProblem) {
  const BodyModel body(ToyBodyData());
  const int T = 16, kTrials = 400;
  SequenceProblem problem;
  problem.layout = FrameLayout::Make(body, CameraKnowledge::kKnown, MakePinhole(640, 480, 500), {0}, 0);
  problem.smoothness[0].root_acceleration = 40;
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  const auto noise = [&](double sigma) {
    return Vector3d::NullaryExpr([&]() { return sigma * normal(random); }).eval();
  };
  for (int t = 0; t < T; ++t) {
    FrameData frame;
    frame.Get<InitialiserTerm>().rotations.assign(body.num_joints(), Eigen::Matrix3d::Identity());
    frame.Get<InitialiserTerm>().weight = t % 5 == 3 || t == 9 ? 0 : 1 + t % 3;
    problem.frames.push_back(frame);
    problem.states.push_back({frame.Get<InitialiserTerm>().rotations, Vector3d(0, 0, 4)});
    problem.timestamps.push_back(t / 30.0 + (t > 7 ? 0.04 : 0));
    problem.cut_before.push_back(t == 12);
  }
  problem.log_focal = problem.log_focal_prior = std::log(500.0);
  const std::array<double, 3> root_sigma = RootAccelerationSigma(problem);
  SolveOptions options;
  options.solver = SequenceSolver::kChain;
  options.function_tolerance = 1e-12;
  VectorXd ratio2 = VectorXd::Zero(T);
  VectorXd sigma;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<Vector3d> truth(T, Vector3d(0, 0, 4));
    Vector3d velocity = noise(1);
    for (int t = 1; t < T; ++t) {
      const double dt = problem.timestamps[t] - problem.timestamps[t - 1];
      if (t >= 2) {
        const Vector3d acceleration = noise(1).cwiseProduct(Vector3d(root_sigma[0], root_sigma[1], root_sigma[2]));
        velocity += 0.5 * (dt + problem.timestamps[t - 1] - problem.timestamps[t - 2]) * acceleration;
      }
      truth[t] = truth[t - 1] + dt * velocity;
    }
    for (int t = 0; t < T; ++t) {
      FrameData& frame = problem.frames[t];
      const double weight = std::max(1e-9, frame.Get<InitialiserTerm>().weight);
      frame.Get<InitialiserTerm>().translation =
          truth[t] + noise(frame.Get<InitialiserTerm>().translation_sigma / std::sqrt(weight));
    }
    SolveSequence(&problem, options);
    if (trial == 0) sigma = PositionSigmaOf(problem, 1).hips;  // the same for all; its joints do not turn
    for (int t = 0; t < T; ++t) {
      ratio2[t] += (problem.states[t].translation - truth[t]).squaredNorm() / (3 * sigma[t] * sigma[t]) / kTrials;
    }
  }
  for (int t = 0; t < T; ++t) EXPECT_NEAR(std::sqrt(ratio2[t]), 1, 0.09) << t;
  EXPECT_GT(sigma.maxCoeff(), 1.5 * sigma.minCoeff());
}

// The whole problem, with noise that keeps it near where it was linearised, and priors that are true.
TEST(Uncertainty, SpreadOfTheErrorsOfTheWholeProblem) {
  double ratio2 = 0, hips_ratio2 = 0;
  int count = 0;
  for (int trial = 0; trial < 25; ++trial) {
    SequenceSceneOptions options;
    options.frames = 4;
    options.outliers = 0;
    options.start_error = 0;
    options.seed = 1000 + trial;
    const auto scene = MakeSequenceScene(options);
    SequenceProblem problem = scene->problem;
    std::mt19937_64 random(trial);
    std::normal_distribution<double> normal;
    const auto noise = [&](double s) { return Vector3d::NullaryExpr([&]() { return s * normal(random); }).eval(); };
    problem.smoothness[0].tip_acceleration = problem.smoothness[0].root_acceleration = 1e4;  // without weight
    problem.shape_prior.sigma = 0.4;                                                         // as the scene draws it
    problem.betas = scene->betas;
    VectorXd gradient;
    const double stature = StatureOfMeanShape(scene->body, static_cast<int>(scene->betas.size()), &gradient);
    problem.shape_prior.height_m =
        stature + gradient.dot(scene->betas) + problem.shape_prior.height_sigma_m * normal(random);
    for (size_t t = 0; t < 4; ++t) {
      FrameData& frame = problem.frames[t];
      for (LandmarkObservation& seen : frame.Get<LandmarkTerm>().seen) seen.sigma_px = 2;
      frame.Get<LandmarkTerm>().kernel = frame.Get<DenseTerm>().kernel = 100;
      frame.Get<JointLimitTerm>().limits = nullptr;
      frame.Get<UprightTerm>().weight = 0;
      frame.Get<StraightKneesTerm>().weight = 0;
      frame.Get<InitialiserTerm>().weight = 1;
      problem.states[t] = scene->truth[t];
      frame.Get<InitialiserTerm>().translation =
          scene->truth[t].translation + noise(frame.Get<InitialiserTerm>().translation_sigma);
      for (int j = 0; j < 24; ++j) {
        frame.Get<InitialiserTerm>().rotations[j] =
            scene->truth[t].rotations[j] * RotationFromAxisAngle(noise(frame.Get<InitialiserTerm>().sigma));
      }
    }
    SolveOptions solve;
    solve.solver = SequenceSolver::kChain;
    SolveSequence(&problem, solve);
    const PositionSigma sigma = PositionSigmaOf(problem, 1);
    const std::array<int, 2> hip = HipJoints(scene->body);
    for (int t = 0; t < 4; ++t) {
      const VectorXd error = JointPositions(problem.layout, problem.states[t], problem.betas) -
                             JointPositions(problem.layout, scene->truth[t], scene->betas);
      const Vector3d hips = 0.5 * (error.segment<3>(3 * hip[0]) + error.segment<3>(3 * hip[1]));
      hips_ratio2 += hips.squaredNorm() / (3 * sigma.hips[t] * sigma.hips[t]) / 100;
      for (int j = 0; j < 24; ++j, ++count) {
        ratio2 += (error.segment<3>(3 * j) - hips).squaredNorm() / (3 * sigma.joints(t, j) * sigma.joints(t, j));
      }
    }
  }
  EXPECT_NEAR(std::sqrt(ratio2 / count), 1, 0.1);
  EXPECT_NEAR(std::sqrt(hips_ratio2), 1, 0.15);
}

TEST(Uncertainty, UnknownWhereTheStateIsNotFiniteAndTheSameBytesForAnyNumberOfThreads) {
  SequenceSceneOptions options;
  options.frames = 9;
  const auto scene = MakeSequenceScene(options);
  const PositionSigma one = PositionSigmaOf(scene->problem, 1);
  EXPECT_TRUE(one.joints.allFinite() && one.hips.allFinite());
  for (int threads : {2, 5}) {
    const PositionSigma many = PositionSigmaOf(scene->problem, threads);
    EXPECT_EQ(many.joints, one.joints);
    EXPECT_EQ(many.hips, one.hips);
  }
  scene->problem.states[3].translation.x() = std::numeric_limits<double>::quiet_NaN();
  const PositionSigma broken = PositionSigmaOf(scene->problem, 1);
  EXPECT_TRUE(broken.joints.array().isNaN().all() && broken.hips.array().isNaN().all());
}

/// A lifter's frame that errs by `across` and `along` the view (scales of its density), the camera's axes turned by
/// `R`.
LiftedFrame FrameThatErrs(double across, double along, const Eigen::Matrix3d& R) {
  LiftedFrame frame;
  frame.camera_from_virtual = R;
  frame.points.setZero(kLifterPoints, 3);
  frame.sigma.resize(kLifterPoints, 2);
  frame.sigma.col(0).setConstant(across);
  frame.sigma.col(1).setConstant(along);
  return frame;
}

// Of the density of lifter_module.h, r² ~ Gamma(3) in units of the scales, one coordinate has the variance E r²/3 = 4:
// drawn.
TEST(Uncertainty, CovarianceOfTheLiftersDensity) {
  const LiftedLandmarks landmarks = CompileLiftedLandmarks(BuiltinBody(), 0);
  const Eigen::Matrix3d R = RotationFromAxisAngle(Vector3d(0.3, -0.5, 0.2));
  const LiftedPose pose = MakeLiftedPose(FrameThatErrs(0.02, 0.05, R), landmarks, 0.9, 0.08);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::gamma_distribution<double> gamma(3);
  Eigen::Matrix3d drawn = Eigen::Matrix3d::Zero();
  constexpr int kDraws = 200000;
  for (int i = 0; i < kDraws; ++i) {
    const Vector3d u = Vector3d::NullaryExpr([&]() { return normal(random); }).normalized();
    const Vector3d error = 0.9 * R * (gamma(random) * u.cwiseProduct(Vector3d(0.02, 0.02, 0.05)));
    drawn += error * error.transpose() / kDraws;
  }
  const int wrist = BuiltinBody().FindJoint("l_wrist");
  EXPECT_LT((pose.JointCovariance(wrist) - drawn).norm(), 0.02 * drawn.norm());
}

TEST(Uncertainty, AJointHasTheLandmarkNearestToIt) {
  const BodyModel& body = BuiltinBody();
  const LiftedLandmarks landmarks = CompileLiftedLandmarks(body, 0);
  const auto nearest = [&](const char* joint) { return landmarks.of_joint.at(body.FindJoint(joint)); };
  EXPECT_EQ(LifterPointNames()[nearest("l_wrist").landmark], "left_wrist");
  EXPECT_EQ(LifterPointNames()[nearest("r_knee").landmark], "right_knee");
  EXPECT_EQ(LifterPointNames()[nearest("r_shoulder").landmark], "right_shoulder");
  EXPECT_NEAR(nearest("r_knee").share, 1, 0.1);
  // Of the pelvis, as far above the middle of the hips as it is.
  BodyPose rest;
  rest.rotations.assign(body.num_joints(), Eigen::Matrix3d::Identity());
  const MatrixX3d hips = PoseLandmarks(body, VectorXd(), rest, {"left_hip", "right_hip"});
  const Eigen::RowVector3d middle = hips.colwise().mean();
  EXPECT_THAT(LifterPointNames()[nearest("pelvis").landmark], testing::EndsWith("_hip"));
  EXPECT_NEAR(nearest("pelvis").share,
              std::min(1.0, (body.joint_template().row(0) - middle).norm() / (hips.row(0) - middle).norm()), 0.02);
  EXPECT_GT(nearest("l_hand").share, 0.95);
}

// Two measurements of one place: variances a and b make ab/(a + b).
TEST(Uncertainty, WhatWasMeasuredAndWhatTheLifterSaysTogether) {
  const LiftedLandmarks landmarks = CompileLiftedLandmarks(BuiltinBody(), 0);
  const LiftedPose pose = MakeLiftedPose(FrameThatErrs(0.03, 0.03, Eigen::Matrix3d::Identity()), landmarks, 1, 0.08);
  const int wrist = BuiltinBody().FindJoint("l_wrist");
  const double lifted = 4 * 0.03 * 0.03;
  const auto sigma_with = [&](const Eigen::Matrix3d& E, const Eigen::Matrix3d& turn) {
    JointSpread spread;
    spread.about_hips.assign(24, E);
    return JointSigmaOf(spread, pose, turn)[wrist];
  };
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const double share = std::pow(landmarks.of_joint[wrist].share, 2);
  for (const double measured : {1e-6, 1e-4, 1e-2, 1.0}) {
    const double a = 4 * measured, b = share * lifted;
    EXPECT_NEAR(sigma_with(measured * I, I), std::sqrt(a * b / (a + b) + 1e-4), 1e-12) << measured;
  }
  EXPECT_NEAR(sigma_with(Eigen::Matrix3d::Zero(), I), 0.01, 1e-12);
  EXPECT_NEAR(sigma_with(1e6 * I, I), JointSigmaOf(pose, 24)[wrist], 1e-6);
  // Not alike along all axes: by the inverses, with the camera turned.
  const LiftedPose flat = MakeLiftedPose(FrameThatErrs(0.01, 0.06, Eigen::Matrix3d::Identity()), landmarks, 1, 0.08);
  const Eigen::Matrix3d turn = RotationFromAxisAngle(Vector3d(0.7, 0.2, -0.4));
  JointSpread spread;
  spread.about_hips.assign(24, Vector3d(0.002, 0.0003, 0.01).asDiagonal());
  const Eigen::Matrix3d E = 4 * spread.about_hips[wrist], L = turn.transpose() * flat.JointCovariance(wrist) * turn;
  const double expected = std::sqrt((E.inverse() + L.inverse()).inverse().trace() / 3 + 1e-4);
  EXPECT_NEAR(JointSigmaOf(spread, flat, turn)[wrist], expected, 1e-12);
}

}  // namespace
}  // namespace bodyloom::uncertainty_test
