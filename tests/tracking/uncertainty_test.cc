// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/uncertainty.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "bodyloom/tracking/solve_sequence.h"
#include "tests/support/dense_chain.h"
#include "tests/support/sequence_scene.h"

namespace bodyloom {
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
    ChainPoint x{problem.states, problem.betas, problem.log_focal};
    chain.Linearise(x);
    MatrixXd H;
    VectorXd g;
    DenseSystem(chain, 7, &H, &g);
    const int n = chain.frame_size(), s = chain.shared_size(), J = scene->body.num_joints();
    H.diagonal().head(7 * n).array() += 1e-6;
    const MatrixXd covariance = H.llt().solve(MatrixXd::Identity(H.rows(), H.rows()));
    const RowMatrixXd sigma = JointPositionSigma(problem, 2);
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
    const VectorXd variance = (D * covariance).cwiseProduct(D).rowwise().sum();
    for (int t = 0; t < 7; ++t) {
      for (int j = 0; j < J; ++j) {
        const double expected = std::sqrt(variance.segment<3>(3 * (t * J + j)).sum() / 3);
        EXPECT_NEAR(sigma(t, j), expected, 1e-7 * expected) << t << " " << j;
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
    frame.initialiser.rotations.assign(body.num_joints(), Eigen::Matrix3d::Identity());
    frame.initialiser.weight = t % 5 == 3 || t == 9 ? 0 : 1 + t % 3;
    problem.frames.push_back(frame);
    problem.states.push_back({frame.initialiser.rotations, Vector3d(0, 0, 4)});
    problem.timestamps.push_back(t / 30.0 + (t > 7 ? 0.04 : 0));
    problem.cut_before.push_back(t == 12);
  }
  problem.log_focal = problem.log_focal_prior = std::log(500.0);
  const std::array<double, 3> root_sigma = RootAccelerationSigma(problem);
  SolveOptions options;
  options.solver = SequenceSolver::kChain;
  options.function_tolerance = 1e-12;
  VectorXd ratio2 = VectorXd::Zero(T);
  RowMatrixXd sigma;
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
      const double weight = std::max(1e-9, frame.initialiser.weight);
      frame.initialiser.translation = truth[t] + noise(frame.initialiser.translation_sigma / std::sqrt(weight));
    }
    SolveSequence(&problem, options);
    if (trial == 0) sigma = JointPositionSigma(problem, 1);  // the same for all
    for (int t = 0; t < T; ++t) {
      ratio2[t] += (problem.states[t].translation - truth[t]).squaredNorm() / (3 * sigma(t, 0) * sigma(t, 0)) / kTrials;
    }
  }
  for (int t = 0; t < T; ++t) EXPECT_NEAR(std::sqrt(ratio2[t]), 1, 0.09) << t;
  EXPECT_GT(sigma.col(0).maxCoeff(), 1.5 * sigma.col(0).minCoeff());
}

// The whole problem, with noise that keeps it near where it was linearised, and priors that are true.
TEST(Uncertainty, SpreadOfTheErrorsOfTheWholeProblem) {
  double ratio2 = 0;
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
      for (LandmarkObservation& seen : frame.landmarks.seen) seen.sigma_px = 2;
      frame.landmarks.kernel = frame.dense.kernel = 100;
      frame.limits.limits = nullptr;
      frame.upright.weight = 0;
      frame.straight_knees.weight = 0;
      frame.initialiser.weight = 1;
      problem.states[t] = scene->truth[t];
      frame.initialiser.translation = scene->truth[t].translation + noise(frame.initialiser.translation_sigma);
      for (int j = 0; j < 24; ++j) {
        frame.initialiser.rotations[j] =
            scene->truth[t].rotations[j] * RotationFromAxisAngle(noise(frame.initialiser.sigma));
      }
    }
    SolveOptions solve;
    solve.solver = SequenceSolver::kChain;
    SolveSequence(&problem, solve);
    const RowMatrixXd sigma = JointPositionSigma(problem, 1);
    for (int t = 0; t < 4; ++t) {
      const VectorXd error = JointPositions(problem.layout, problem.states[t], problem.betas) -
                             JointPositions(problem.layout, scene->truth[t], scene->betas);
      for (int j = 0; j < 24; ++j, ++count) {
        ratio2 += error.segment<3>(3 * j).squaredNorm() / (3 * sigma(t, j) * sigma(t, j));
      }
    }
  }
  EXPECT_NEAR(std::sqrt(ratio2 / count), 1, 0.1);
}

TEST(Uncertainty, UnknownWhereTheStateIsNotFiniteAndTheSameBytesForAnyNumberOfThreads) {
  SequenceSceneOptions options;
  options.frames = 9;
  const auto scene = MakeSequenceScene(options);
  const RowMatrixXd one = JointPositionSigma(scene->problem, 1);
  EXPECT_TRUE(one.allFinite());
  for (int threads : {2, 5}) EXPECT_EQ(JointPositionSigma(scene->problem, threads), one);
  scene->problem.states[3].translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(JointPositionSigma(scene->problem, 1).array().isNaN().all());
}

}  // namespace
}  // namespace bodyloom
