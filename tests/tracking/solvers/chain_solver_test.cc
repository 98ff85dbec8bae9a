// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/chain_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "tests/support/sequence_scene.h"
#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/frame_term.h"
#include "tracking/solvers/solve_sequence.h"
#include "tracking/terms/dense/dense.h"
#include "tracking/terms/initialiser.h"
#include "tracking/terms/landmarks.h"

namespace bodyloom::chain_solver_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

SolveOptions Tight(SequenceSolver solver) {
  SolveOptions options;
  options.solver = solver;
  options.max_iterations = 200;
  options.function_tolerance = 1e-12;
  return options;
}

/// Both engines from the same start; costs agree to 1e-6 and states closely.
void ExpectSameAsCeres(const SequenceProblem& start, const SolveOptions& base = {}) {
  SequenceProblem by_ceres = start, by_chain = start;
  SolveOptions options = Tight(SequenceSolver::kCeres);
  options.shape_constant = base.shape_constant;
  options.focal_constant = base.focal_constant;
  const SolveReport ceres = SolveSequence(&by_ceres, options);
  options.solver = SequenceSolver::kChain;
  const SolveReport chain = SolveSequence(&by_chain, options);
  ASSERT_EQ(ceres.status, SolveStatus::kConverged) << ceres.message;
  ASSERT_EQ(chain.status, SolveStatus::kConverged) << chain.message;
  EXPECT_NEAR(chain.initial_cost, ceres.initial_cost, 1e-10 * ceres.initial_cost);
  EXPECT_LT(chain.final_cost, 0.7 * chain.initial_cost);
  EXPECT_NEAR(chain.final_cost, ceres.final_cost, 1e-6 * ceres.final_cost);
  EXPECT_LT((by_chain.betas - by_ceres.betas).norm(), 1e-3);
  EXPECT_NEAR(by_chain.log_focal, by_ceres.log_focal, 1e-4);
  if (base.shape_constant) {
    EXPECT_EQ(by_chain.betas, start.betas);
  }
  if (base.focal_constant) {
    EXPECT_EQ(by_chain.log_focal, start.log_focal);
  }
}

TEST(ChainSolver, SameCostAsCeresInEveryCamera) {
  for (CameraKnowledge knowledge : {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    SequenceSceneOptions options;
    options.knowledge = knowledge;
    const auto owner = MakeSequenceScene(options);
    ExpectSameAsCeres(owner->problem);
  }
}

TEST(ChainSolver, SameCostAsCeresForEveryLength) {
  for (int frames : {1, 2, 3, 4, 9}) {
    SequenceSceneOptions options;
    options.frames = frames;
    options.seed = 10 + frames;
    const auto owner = MakeSequenceScene(options);
    ExpectSameAsCeres(owner->problem);
  }
}

TEST(ChainSolver, SameCostAsCeresWithCutsGapsAndUnevenTimes) {
  SequenceSceneOptions options;
  options.frames = 12;
  auto scene = MakeSequenceScene(options);
  SequenceProblem& problem = scene->problem;
  problem.cut_before[5] = problem.cut_before[6] = 1;
  for (size_t t = 8; t < 12; ++t) problem.timestamps[t] += 0.1 * double(t - 7);
  problem.frames[9].Get<LandmarkTerm>().seen.clear();  // nothing was seen; the neighbours and the limits hold it
  problem.frames[9].Get<DenseTerm>().points = nullptr;
  problem.frames[9].Get<InitialiserTerm>().weight = 1e-3;
  ExpectSameAsCeres(problem);
}

TEST(ChainSolver, SameCostAsCeresWithVelocities) {
  for (CameraKnowledge knowledge : {CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    for (int frames : {2, 12}) {
      SequenceSceneOptions options;
      options.knowledge = knowledge;
      options.frames = frames;
      auto scene = MakeSequenceScene(options);
      SequenceProblem& problem = scene->problem;
      problem.velocity_weight = 30;
      if (frames == 12) {
        problem.cut_before[5] = problem.cut_before[6] = 1;
        for (size_t t = 8; t < 12; ++t) problem.timestamps[t] += 0.1 * double(t - 7);
      }
      ExpectSameAsCeres(problem);
    }
  }
}

/// Σ over frames of the squared angles between neighbours.
double Turned(const SequenceProblem& problem) {
  double sum = 0;
  for (size_t t = 1; t < problem.states.size(); ++t) {
    for (const int j : problem.layout.active_joints) {
      const Matrix3d turn = problem.states[t - 1].rotations[j].transpose() * problem.states[t].rotations[j];
      sum += Eigen::AngleAxisd(turn).angle() * Eigen::AngleAxisd(turn).angle();
    }
  }
  return sum;
}

TEST(ChainSolver, TheDearerVelocitiesTheStillerThePerson) {
  const auto scene = MakeSequenceScene({});
  double before = INFINITY;
  for (const double weight : {0.0, 1.0, 100.0, 1e5}) {
    SequenceProblem problem = scene->problem;
    problem.velocity_weight = weight;
    SolveSequence(&problem, Tight(SequenceSolver::kChain));
    const double turned = Turned(problem);
    EXPECT_LT(turned, before) << weight;
    before = turned;
  }
  EXPECT_LT(before, 1e-2);
}

TEST(ChainSolver, SharedValuesMayBeConstant) {
  SequenceSceneOptions scene;
  scene.knowledge = CameraKnowledge::kUnknownFocal;
  SolveOptions options;
  for (int which : {1, 2, 3}) {
    options.shape_constant = which & 1;
    options.focal_constant = which & 2;
    const auto owner = MakeSequenceScene(scene);
    ExpectSameAsCeres(owner->problem, options);
  }
}

TEST(ChainSolver, SameBytesForAnyNumberOfThreads) {
  SequenceSceneOptions scene;
  scene.frames = 11;
  scene.knowledge = CameraKnowledge::kUnknownFocal;
  auto owner = MakeSequenceScene(scene);
  SequenceProblem start = owner->problem;
  start.cut_before[7] = 1;
  SolveOptions options;
  options.solver = SequenceSolver::kChain;
  SequenceProblem expected = start;
  const SolveReport one = SolveSequence(&expected, options);
  for (int threads : {2, 3, 8}) {
    SequenceProblem problem = start;
    options.num_threads = threads;
    const SolveReport report = SolveSequence(&problem, options);
    EXPECT_EQ(report.final_cost, one.final_cost) << threads;
    EXPECT_EQ(report.iterations, one.iterations) << threads;
    EXPECT_EQ(problem.betas, expected.betas) << threads;
    EXPECT_EQ(problem.log_focal, expected.log_focal) << threads;
    for (size_t t = 0; t < start.states.size(); ++t) {
      EXPECT_EQ(problem.states[t].rotations, expected.states[t].rotations) << threads;
      EXPECT_EQ(problem.states[t].translation, expected.states[t].translation) << threads;
    }
  }
}

TEST(ChainSolver, StaysARotationOverManySteps) {
  SequenceSceneOptions scene;
  scene.frames = 3;
  auto owner = MakeSequenceScene(scene);
  SolveOptions options;
  options.solver = SequenceSolver::kChain;
  for (int round = 0; round < 50; ++round) SolveSequence(&owner->problem, options);
  for (const FrameState& state : owner->problem.states) {
    for (const Matrix3d& R : state.rotations) EXPECT_LT((R.transpose() * R - Matrix3d::Identity()).norm(), 1e-14);
  }
}

TEST(ChainSolver, StopsWhenTheCallerSaysSoAndAtTheLastIteration) {
  auto owner = MakeSequenceScene({});
  SolveOptions options;
  options.solver = SequenceSolver::kChain;
  std::vector<double> costs;
  options.on_iteration = [&](int iteration, double cost) {
    EXPECT_EQ(iteration, static_cast<int>(costs.size()));
    costs.push_back(cost);
    return iteration < 2;
  };
  SequenceProblem problem = owner->problem;
  EXPECT_EQ(SolveSequence(&problem, options).status, SolveStatus::kStopped);
  EXPECT_EQ(costs.size(), 3U);
  EXPECT_LT(costs[2], costs[0]);
  options.on_iteration = nullptr;
  options.max_iterations = 2;
  problem = owner->problem;
  const SolveReport report = SolveSequence(&problem, options);
  EXPECT_EQ(report.status, SolveStatus::kMaxIterations);
  EXPECT_DOUBLE_EQ(report.final_cost, costs[2]);
}

TEST(ChainSolver, AStartThatIsNotFiniteFailsAndLeavesTheProblemAlone) {
  auto owner = MakeSequenceScene({});
  owner->problem.states[3].translation.x() = std::numeric_limits<double>::quiet_NaN();
  SequenceProblem problem = owner->problem;
  SolveOptions options;
  options.solver = SequenceSolver::kChain;
  EXPECT_EQ(SolveSequence(&problem, options).status, SolveStatus::kFailure);
  EXPECT_EQ(problem.states[2].rotations, owner->problem.states[2].rotations);
}

TEST(ChainSolver, AFrameThatNothingHoldsStaysWhereItIs) {
  SequenceSceneOptions scene;
  scene.frames = 5;
  auto owner = MakeSequenceScene(scene);
  SequenceProblem& problem = owner->problem;
  problem.frames[4] = FrameData();
  problem.cut_before[4] = 1;
  const FrameState before = problem.states[4];
  SolveOptions options;
  options.solver = SequenceSolver::kChain;
  EXPECT_EQ(SolveSequence(&problem, options).status, SolveStatus::kConverged);
  EXPECT_EQ(problem.states[4].translation, before.translation);
  for (int j = 0; j < 24; ++j) {
    EXPECT_LT((problem.states[4].rotations[j] - before.rotations[j]).norm(), 1e-14);
  }
}

/// ½ |x| of the translation's x as the square of sign(x) √|x|, whose undamped step leads to −x, at the same cost.
class SquareRootTerm : public CopyableTerm<SquareRootTerm> {
 public:
  [[nodiscard]] std::string name() const override { return "square root"; }
  [[nodiscard]] int num_rows() const override { return 1; }
  void Add(FrameAccumulator* sums) const override {
    const double x = sums->state().translation.x(), root = std::sqrt(std::abs(x));
    sums->AddGroup(1, root * root, 0, 1);
    if (!sums->derivatives() || root == 0) return;
    const Eigen::Matrix<double, 1, 3> d(1 / (2 * root), 0, 0);
    sums->AddBlockRows<1>(sums->layout().translation_column, d, Eigen::Matrix<double, 1, 1>(x < 0 ? -root : root));
  }
};

TEST(ChainSolver, AStepThatMissesItsPredictedDecreaseIsNotTheLast) {
  SequenceSceneOptions scene;
  scene.frames = 1;
  auto owner = MakeSequenceScene(scene);
  SequenceProblem& problem = owner->problem;
  problem.frames[0] = FrameData();
  problem.frames[0].terms.Add(std::make_unique<SquareRootTerm>());
  problem.states[0].translation.x() = 1;
  SolveOptions options;
  options.solver = SequenceSolver::kChain;
  options.shape_constant = true;
  options.function_tolerance = 1e-3;  // the damped step gains less
  SolveSequence(&problem, options);
  EXPECT_LT(std::abs(problem.states[0].translation.x()), 0.05);
}

TEST(ChainSolver, EarlyIterationsOnFewerPointsEndAtTheWholeProblem) {
  SequenceSceneOptions scene;
  scene.dense = 150;
  scene.outliers = 0;
  const auto owner = MakeSequenceScene(scene);
  SequenceProblem all = owner->problem, early = owner->problem;
  SolveOptions options = Tight(SequenceSolver::kChain);
  const SolveReport whole = SolveSequence(&all, options);
  options.chain.early_dense = 40;
  const SolveReport report = SolveSequence(&early, options);
  ASSERT_EQ(report.status, SolveStatus::kConverged);
  EXPECT_NE(report.initial_cost, whole.initial_cost);  // it did start with fewer
  EXPECT_NEAR(report.final_cost, whole.final_cost, 1e-6 * whole.final_cost);
  options.max_iterations = 1;  // ends among the few, and reports the cost of all
  early = owner->problem;
  const SolveReport one = SolveSequence(&early, options);
  options.chain.early_dense = 0;
  options.max_iterations = 0;
  EXPECT_NEAR(SolveSequence(&early, options).initial_cost, one.final_cost, 1e-12 * one.final_cost);
}

TEST(ChainSolver, FrozenFramesEndAtTheSameMinimum) {
  for (const uint64_t seed : {1, 2, 3}) {
    SequenceSceneOptions scene;
    scene.frames = 40;
    scene.seed = seed;
    scene.outliers = 0;  // one minimum, whatever the path …
    scene.dense = 100;   // … and no valley: with fewer keypoints some joint is hardly held
    const auto owner = MakeSequenceScene(scene);
    SequenceProblem moving = owner->problem, frozen = owner->problem;
    // Two frames far from where they belong, so that the others have to wait for them.
    for (SequenceProblem* problem : {&moving, &frozen}) {
      for (const int t : {11, 30}) problem->states[t].translation += Vector3d(0.2, -0.1, 0.3);
    }
    SequenceProblem other = frozen;
    SolveOptions options = Tight(SequenceSolver::kChain);
    options.function_tolerance = 1e-9;
    const SolveReport all = SolveSequence(&moving, options);
    options.chain.frozen_share = 0.05;
    const SolveReport some = SolveSequence(&frozen, options);
    ASSERT_EQ(some.status, SolveStatus::kConverged) << some.message;
    EXPECT_EQ(all.frames_skipped, 0);
    EXPECT_GT(some.frames_skipped, some.frames_evaluated / 10);
    EXPECT_NEAR(some.final_cost, all.final_cost, 1e-6 * all.final_cost);
    EXPECT_LT((frozen.betas - moving.betas).norm(), 1e-3);
    options.num_threads = 3;
    const SolveReport threads = SolveSequence(&other, options);
    EXPECT_EQ(threads.final_cost, some.final_cost);
    EXPECT_EQ(other.states[20].translation, frozen.states[20].translation);
    EXPECT_EQ(other.betas, frozen.betas);
  }
}

TEST(ChainSolver, AllFramesAreCountedAtTheLastIterationAlsoWhileSomeAreFrozen) {
  SequenceSceneOptions scene;
  scene.frames = 40;
  const auto owner = MakeSequenceScene(scene);
  SolveOptions options = Tight(SequenceSolver::kChain);
  options.chain.frozen_share = 0.05;
  for (int iterations = 1; iterations < 12; ++iterations) {
    SequenceProblem problem = owner->problem;
    options.max_iterations = iterations;
    const SolveReport report = SolveSequence(&problem, options);
    SolveOptions none = options;
    none.max_iterations = 0;
    EXPECT_NEAR(SolveSequence(&problem, none).initial_cost, report.final_cost, 1e-12 * report.final_cost) << iterations;
  }
}

}  // namespace
}  // namespace bodyloom::chain_solver_test
