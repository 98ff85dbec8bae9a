// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/fixed_lag.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "tests/support/dense_chain.h"
#include "tests/support/sequence_scene.h"
#include "tracking/solvers/chain/chain_inverse.h"
#include "tracking/solvers/solve_sequence.h"
#include "tracking/terms/initialiser.h"

namespace bodyloom::fixed_lag_test {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

SequenceProblem WithoutFrames(const SequenceProblem& problem) { return SelectFrames(problem, {}); }

SequenceProblem FirstFrames(const SequenceProblem& problem, int count) {
  std::vector<int> frames(count);
  for (int t = 0; t < count; ++t) frames[t] = t;
  return SelectFrames(problem, frames);
}

TEST(ChainPrior, MarginalStepsEqualThoseOfTheWholeSystem) {
  for (CameraKnowledge knowledge : {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal}) {
    SequenceSceneOptions options;
    options.frames = 6;
    options.knowledge = knowledge;
    const auto scene = MakeSequenceScene(options);
    SequenceProblem problem = scene->problem;
    ChainPoint x(problem.states, problem);
    ChainPrior priors[2];
    ChainProblem chain(problem, false, false, 1);
    chain.Linearise(x);
    MatrixXd H;
    VectorXd g;
    DenseSystem(chain, 6, &H, &g);
    const VectorXd whole = -H.ldlt().solve(g);
    // Two frames leave, one after the other.
    for (int gone = 0; gone < 2; ++gone) {
      ASSERT_TRUE(chain.Marginalise(x, &priors[gone]));
      problem = SelectFrames(problem, [&]() {
        std::vector<int> rest;
        for (size_t t = 1; t < problem.states.size(); ++t) rest.push_back(static_cast<int>(t));
        return rest;
      }());
      x.states = problem.states;
      chain.SetPrior(&priors[gone]);
      chain.Moved(1);
      chain.Linearise(x);
      const int T = 5 - gone, left = T * chain.frame_size() + chain.shared_size();
      DenseSystem(chain, T, &H, &g);
      EXPECT_LT((-H.ldlt().solve(g) - whole.tail(left)).norm(), 1e-6 * whole.norm()) << gone;
      // And so does the block elimination, which must take up the dense coupling that the prior brings.
      ChainFactor factor(chain.frame_size(), chain.shared_size(), chain.cut_before());
      VectorXd step, shared, both(left);
      const VectorXd none = VectorXd::Zero(T * chain.frame_size());
      chain.SetDamping(&none);
      ASSERT_TRUE(factor.Solve(chain, chain.shared(), -chain.shared_gradient(), 2, &step, &shared));
      both << step, shared;
      EXPECT_LT((both - whole.tail(left)).norm(), 1e-6 * whole.norm()) << gone;
    }
  }
}

TEST(ChainPrior, GradientIsTheDerivativeOfTheCost) {
  SequenceSceneOptions options;
  options.knowledge = CameraKnowledge::kUnknownFocal;
  const auto scene = MakeSequenceScene(options);
  SequenceProblem problem = scene->problem;
  ChainProblem chain(problem, false, false, 1);
  ChainPoint x(problem.states, problem);
  chain.Linearise(x);
  ChainPrior prior;
  ASSERT_TRUE(chain.Marginalise(x, &prior));
  problem.frames.assign(problem.frames.size(), FrameData());  // what is left is prior and smoothness
  for (int t = 0; t < 6; ++t) chain.Forget(t);
  chain.SetPrior(&prior);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const int n = chain.frame_size(), s = chain.shared_size();
  const auto random_step = [&](int size, double scale) {
    return VectorXd(VectorXd::NullaryExpr(size, [&]() { return scale * normal(random); }));
  };
  ChainPoint at, a, b;
  chain.Plus(x, random_step(6 * n, 0.1), random_step(s, 0.1), &at);
  chain.Linearise(at);
  for (int trial = 0; trial < 20; ++trial) {
    const VectorXd step = random_step(6 * n, 1), shared = random_step(s, 1);
    const double expected = chain.gradient().dot(step) + chain.shared_gradient().dot(shared), h = 1e-5;
    chain.Plus(at, h * step, h * shared, &a);
    chain.Plus(at, -h * step, -h * shared, &b);
    EXPECT_NEAR((chain.Cost(a) - chain.Cost(b)) / (2 * h), expected, 1e-5 * std::abs(expected) + 1e-4) << trial;
  }
}

/// A clip in which everything is linear: the translation is measured, rotations are held at rest.
SequenceProblem LinearClip(const SequenceScene& scene, int frames) {
  SequenceProblem problem = scene.problem;
  problem.frames.clear();
  problem.states.clear();
  problem.timestamps.clear();
  problem.cut_before.clear();
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  for (int t = 0; t < frames; ++t) {
    FrameData frame;
    frame.Get<InitialiserTerm>().rotations.assign(24, Matrix3d::Identity());
    frame.Get<InitialiserTerm>().translation =
        Vector3d(0.3 * std::sin(0.3 * t), 0.02 * t, 4) + 0.1 * Vector3d::NullaryExpr([&]() { return normal(random); });
    frame.Get<InitialiserTerm>().weight = t % 7 == 3 ? 0 : 0.5 + 0.1 * (t % 5);  // now and then nothing is seen
    problem.frames.push_back(frame);
    problem.states.push_back({frame.Get<InitialiserTerm>().rotations, Vector3d(0, 0, 4)});
    problem.timestamps.push_back(t / 30.0 + (t > 9 ? 0.05 : 0));
    problem.cut_before.push_back(t == 14);
  }
  return problem;
}

TEST(FixedLag, EqualsTheBatchOfAllFramesSoFarWhenEverythingIsLinear) {
  const auto scene = MakeSequenceScene({});
  const int T = 24;
  const SequenceProblem clip = LinearClip(*scene, T);
  for (int window : {3, 4, 6}) {
    FixedLag lag(WithoutFrames(clip), window, 1);
    for (int t = 0; t < T; ++t) {
      lag.Add(clip.frames[t], clip.states[t], clip.timestamps[t], clip.cut_before[t]);
      lag.Solve(20, 0, 1e-15);
      SequenceProblem batch = FirstFrames(clip, t + 1);
      SolveOptions options;
      options.solver = SequenceSolver::kChain;
      options.function_tolerance = 1e-14;
      SolveSequence(&batch, options);
      ASSERT_EQ(lag.num_frames(), std::min(t + 1, window));
      for (int i = 0; i < lag.num_frames(); ++i) {
        const FrameState &a = lag.problem().states[i], &b = batch.states[t + 1 - lag.num_frames() + i];
        EXPECT_LT((a.translation - b.translation).norm(), 2e-7) << "window " << window << " frame " << t << " at " << i;
      }
    }
  }
}

TEST(FixedLag, CovarianceEqualsTheBatchsWhenEverythingIsLinear) {
  const auto scene = MakeSequenceScene({});
  const int T = 20;
  const SequenceProblem clip = LinearClip(*scene, T);
  FixedLag lag(WithoutFrames(clip), 5, 1);
  for (int t = 0; t < T; ++t) {
    lag.Add(clip.frames[t], clip.states[t], clip.timestamps[t], clip.cut_before[t]);
    lag.Solve(20, 0, 1e-15);
    SequenceProblem batch = FirstFrames(clip, t + 1);
    const int open = lag.num_frames();
    for (int i = 0; i < open; ++i) batch.states[t + 1 - open + i] = lag.problem().states[i];
    ChainProblem chain(batch, false, false, 1);
    ChainFactor factor(chain.frame_size(), chain.shared_size(), chain.cut_before());
    chain.Linearise(ChainPoint(batch.states, batch));
    std::vector<MatrixXd> expected(t + 1);
    ASSERT_TRUE(VisitCovariance(&chain, &factor, 0, t + 1, 1, [&](int i, const MatrixXd& P) { expected[i] = P; }));
    int visited = 0;
    ASSERT_TRUE(lag.VisitCovariance(0, open, [&](int i, const MatrixXd& P) {
      const MatrixXd& whole = expected[t + 1 - open + i];
      // The regularisation of unconstrained frames, 1e-6, is added again with every frame that leaves.
      EXPECT_LT((P - whole).norm(), 1e-4 * whole.norm()) << "frame " << t << " at " << i;
      ++visited;
    }));
    EXPECT_EQ(visited, open);
  }
}

TEST(FixedLag, StaysNearTheBatchOnARealProblem) {
  SequenceSceneOptions options;
  options.frames = 30;
  options.knowledge = CameraKnowledge::kUnknownFocal;
  options.start_error = 0.03;
  const auto scene = MakeSequenceScene(options);
  SequenceProblem batch = scene->problem;
  SolveOptions solve;
  solve.solver = SequenceSolver::kChain;
  SolveSequence(&batch, solve);
  FixedLag lag(WithoutFrames(scene->problem), 8, 2);
  for (int t = 0; t < 30; ++t) {
    lag.Add(scene->problem.frames[t], scene->problem.states[t], scene->problem.timestamps[t], false);
    lag.Solve(4, 1e-4);
  }
  const auto error = [&](const FrameState& a, const FrameState& b) {
    double sum = 0;
    for (int j = 0; j < 24; ++j) sum += AxisAngleFromRotation(a.rotations[j].transpose() * b.rotations[j]).norm() / 24;
    return sum;
  };
  double live = 0, whole = 0;
  for (int i = 0; i < 8; ++i) {
    live += error(lag.problem().states[i], scene->truth[22 + i]);
    whole += error(batch.states[22 + i], scene->truth[22 + i]);
  }
  EXPECT_LT(live, 1.25 * whole);
  EXPECT_LT((lag.problem().betas - batch.betas).norm(), 0.3);
}

TEST(FixedLag, SameBytesForAnyNumberOfThreads) {
  SequenceSceneOptions options;
  options.frames = 14;
  const auto scene = MakeSequenceScene(options);
  std::vector<FrameState> expected;
  for (int threads : {1, 2, 5}) {
    FixedLag lag(WithoutFrames(scene->problem), 5, threads);
    std::vector<FrameState> states;
    for (int t = 0; t < 14; ++t) {
      lag.Add(scene->problem.frames[t], scene->problem.states[t], scene->problem.timestamps[t], t == 9);
      lag.Solve(2, 1e-3);
      states.push_back(lag.problem().states.back());
    }
    if (threads == 1) expected = states;
    for (int t = 0; t < 14; ++t) {
      EXPECT_EQ(states[t].rotations, expected[t].rotations);
      EXPECT_EQ(states[t].translation, expected[t].translation);
    }
  }
}

TEST(ChainSolver, ReusedLinearisationsEndAtTheSameCost) {
  for (uint64_t seed : {1, 2, 3}) {
    SequenceSceneOptions options;
    options.frames = 20;
    options.outliers = 0;  // one minimum, whatever the path …
    options.dense = 100;   // … and no valley: with fewer keypoints some joint is hardly held
    options.seed = seed;
    options.knowledge = seed == 2 ? CameraKnowledge::kUnknownFocal : CameraKnowledge::kKnown;
    const auto scene = MakeSequenceScene(options);
    SequenceProblem start = scene->problem;
    // Half of the clip begins where it will end.
    SolveOptions solve;
    solve.solver = SequenceSolver::kChain;
    solve.max_iterations = 200;
    solve.function_tolerance = 1e-12;
    SequenceProblem all = start;
    SolveSequence(&all, solve);
    for (size_t t = 0; t < 10; ++t) start.states[t] = all.states[t];
    SequenceProblem reused = all = start;
    const SolveReport whole = SolveSequence(&all, solve);
    EXPECT_EQ(whole.frames_skipped, 0);
    solve.chain.reuse_linearisation = 0.03;
    const SolveReport report = SolveSequence(&reused, solve);
    ASSERT_EQ(report.status, SolveStatus::kConverged);
    EXPECT_GT(report.frames_skipped, 10) << seed;
    EXPECT_NEAR(report.final_cost, whole.final_cost, 1e-6 * whole.final_cost) << seed;
    // The reported cost is that of the states, with no linearisation reused.
    solve.chain.reuse_linearisation = 0;
    solve.max_iterations = 0;
    EXPECT_NEAR(SolveSequence(&reused, solve).initial_cost, report.final_cost, 1e-12 * report.final_cost);
  }
}

}  // namespace
}  // namespace bodyloom::fixed_lag_test
