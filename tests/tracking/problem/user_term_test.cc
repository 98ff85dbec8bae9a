// SPDX-License-Identifier: Apache-2.0
// User cost functions in the problem: derivatives, both engines, couplings of frames, moving cameras.
#include "tracking/problem/user_term.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "data_tools/synthesis/clips/demo_motion.h"
#include "geometry/scene/camera_path.h"
#include "tests/support/dense_chain.h"
#include "tests/support/sequence_scene.h"
#include "tests/tracking/problem/user_term_kinds.h"
#include "tracking/problem/moving_camera.h"
#include "tracking/problem/user_cost.h"
#include "tracking/solvers/chain/chain_problem.h"
#include "tracking/solvers/solve_sequence.h"

namespace bodyloom::user_term_test {
namespace {

using namespace user_term_kinds;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

TEST(UserTerm, DerivativesMatchDifferencesThroughTheProblem) {
  for (CameraKnowledge knowledge : {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    SequenceSceneOptions options;
    options.frames = 7;
    options.knowledge = knowledge;
    const auto scene = MakeSequenceScene(options);
    for (FrameData& frame : scene->problem.frames) frame = FrameData();  // users' terms, smoothness and shape alone
    AddUserTerms(AllKinds(scene->body, knowledge), &scene->problem);
    ASSERT_EQ(scene->problem.frames[1].terms.size(), 3U);
    ASSERT_EQ(scene->problem.frames[2].terms.size(), 4U);
    ASSERT_EQ(scene->problem.couplings.size(), 6U + 2U);
    ChainProblem chain(scene->problem, false, false, 2);
    const ChainPoint x(scene->problem.states, scene->problem);
    const int frames = options.frames * chain.frame_size(), s = chain.shared_size();
    ASSERT_GT(chain.Linearise(x), 0);
    const VectorXd gradient = chain.gradient(), shared = chain.shared_gradient();
    constexpr double kStep = 1e-6;
    int checked = 0;
    for (int k = 0; k < frames + s; ++k) {
      double cost[2];
      for (int side = 0; side < 2; ++side) {
        const double step = side == 0 ? kStep : -kStep;
        ChainPoint y;
        chain.Plus(x, k < frames ? VectorXd(step * VectorXd::Unit(frames, k)) : VectorXd(VectorXd::Zero(frames)),
                   k < frames ? VectorXd(VectorXd::Zero(s)) : VectorXd(step * VectorXd::Unit(s, k - frames)), &y);
        cost[side] = chain.Cost(y);
      }
      const double numeric = (cost[0] - cost[1]) / (2 * kStep);
      EXPECT_NEAR(k < frames ? gradient[k] : shared[k - frames], numeric, 1e-6 * gradient.norm()) << k;
      ++checked;
    }
    EXPECT_GT(checked, 300);
  }
}

TEST(UserTerm, TheChainsMatrixHasTheCouplingsOfFrames) {
  SequenceSceneOptions options;
  options.frames = 9;  // long enough for both directions of the elimination
  const auto scene = MakeSequenceScene(options);
  AddUserTerms(AllKinds(scene->body, options.knowledge), &scene->problem);
  ChainProblem chain(scene->problem, false, false, 2);
  ASSERT_TRUE(std::isfinite(chain.Linearise(ChainPoint(scene->problem.states, scene->problem))));
  MatrixXd H;
  VectorXd g;
  DenseSystem(chain, options.frames, &H, &g);
  const int n = chain.frame_size();
  EXPECT_GT(H.block(0, n, 3, 3).norm() + H.block(6, n, 3, n).norm(), 0);
  EXPECT_LE((H.diagonal().head(options.frames * n) - chain.diagonal()).norm(), 1e-9 * chain.diagonal().norm());
  const VectorXd damping = VectorXd::Constant(options.frames * n, 1e-3);
  chain.SetDamping(&damping);
  H.diagonal().head(options.frames * n) += damping;
  ASSERT_GT(chain.num_far_rows(), 0);
  ChainFactor factor(n, chain.arrow_size(), chain.cut_before(), chain.num_far_rows());
  VectorXd step, shared_step, rhs = VectorXd::Zero(chain.arrow_size());
  rhs.head(chain.shared_size()) = -chain.shared_gradient();
  const MatrixXd arrow = chain.Arrow(VectorXd::Zero(chain.shared_size()));
  ASSERT_TRUE(factor.Solve(chain, arrow, rhs, 2, &step, &shared_step));
  VectorXd x(step.size() + chain.shared_size());
  x << step, shared_step.head(chain.shared_size());
  EXPECT_LE((H * x + g).norm(), 1e-8 * g.norm());
}

/// Costs to 1e-6; the answers differ from those without the terms.
void ExpectEnginesAgree(const std::vector<UserTerm>& terms, SequenceSceneOptions scene_options) {
  const auto scene = MakeSequenceScene(scene_options);
  SolveOptions options;
  options.max_iterations = 300;
  options.function_tolerance = 1e-12;
  options.num_threads = 2;
  SequenceProblem without = scene->problem;
  SolveSequence(&without, options);
  AddUserTerms(terms, &scene->problem);
  SequenceProblem by_ceres = scene->problem, by_chain = scene->problem;
  options.solver = SequenceSolver::kCeres;
  const SolveReport ceres = SolveSequence(&by_ceres, options);
  options.solver = SequenceSolver::kChain;
  const SolveReport chain = SolveSequence(&by_chain, options);
  options.chain.frozen_share = kTrackerFrozenShare;
  options.chain.reuse_linearisation = kTrackerReuse;
  SequenceProblem by_reuse = scene->problem;
  const SolveReport reuse = SolveSequence(&by_reuse, options);
  ASSERT_EQ(ceres.status, SolveStatus::kConverged) << ceres.message;
  ASSERT_EQ(chain.status, SolveStatus::kConverged) << chain.message;
  EXPECT_NEAR(chain.initial_cost, ceres.initial_cost, 1e-10 * ceres.initial_cost);
  EXPECT_NEAR(chain.final_cost, ceres.final_cost, 1e-6 * ceres.final_cost);
  // Skips may lead into another minimum of the robust cost than every frame in every step does: a minimum it is, by
  // what Ceres makes of it, and none that is worse.
  EXPECT_LE(reuse.final_cost, (1 + 1e-6) * ceres.final_cost);
  SolveOptions polish = options;
  polish.solver = SequenceSolver::kCeres;
  EXPECT_NEAR(SolveSequence(&by_reuse, polish).final_cost, reuse.final_cost, 1e-6 * reuse.final_cost);
  double moved = 0;
  for (size_t t = 0; t < without.states.size(); ++t) {
    moved += (without.states[t].translation - by_chain.states[t].translation).norm();
  }
  EXPECT_GT(moved, 1e-4);
}

TEST(UserTerm, BothEnginesAgreeOnEachKind) {
  const BodyModel body(ToyBodyData());
  const SequenceSceneOptions options;
  ExpectEnginesAgree({Pull()}, options);
  ExpectEnginesAgree({Pull(std::make_shared<ceres::CauchyLoss>(2.0))}, options);
  ExpectEnginesAgree({Distance()}, options);
  ExpectEnginesAgree({Pose(body)}, options);
  ExpectEnginesAgree({Neighbours()}, options);
  ExpectEnginesAgree({Neighbours(std::make_shared<ceres::HuberLoss>(1.5))}, options);
  ExpectEnginesAgree({Seen(body)}, options);
  ExpectEnginesAgree({Loop(body)}, options);
  ExpectEnginesAgree({Loop(body, std::make_shared<ceres::CauchyLoss>(3.0))}, options);
}

TEST(UserTerm, BothEnginesAgreeInEveryCameraAndLength) {
  const BodyModel body(ToyBodyData());
  for (CameraKnowledge knowledge : {CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    SequenceSceneOptions options;
    options.knowledge = knowledge;
    ExpectEnginesAgree({Distance(), Pose(body, knowledge), Neighbours(), Loop(body)}, options);
    if (knowledge == CameraKnowledge::kUnknownFocal) ExpectEnginesAgree({Seen(body)}, options);
  }
  for (const int frames : {2, 3, 11}) {
    SequenceSceneOptions options;
    options.frames = frames;
    ExpectEnginesAgree({Pull(), Neighbours()}, options);
  }
}

TEST(UserTerm, CouplingsDoNotReachAcrossACutUnlessTheySaySo) {
  const auto scene = MakeSequenceScene({});
  scene->problem.cut_before[3] = 1;
  SequenceProblem with = scene->problem;
  UserTerm term = Neighbours();
  AddUserTerms(std::vector<UserTerm>{term}, &with);
  std::vector<int> first;
  for (const FrameCoupling& coupling : with.couplings) first.push_back(coupling.frames[0]);
  EXPECT_EQ(first, (std::vector<int>{0, 1, 3, 4}));
  const SequenceProblem some = SelectFrames(with, {0, 1, 4});
  ASSERT_EQ(some.couplings.size(), 1U);
  EXPECT_EQ(some.couplings[0].frames, (std::vector<int>{0, 1}));
  term.across_cuts = true;
  SequenceProblem across = scene->problem;
  AddUserTerms(std::vector<UserTerm>{term}, &across);
  EXPECT_EQ(across.couplings.size(), 5U);
  ExpectEnginesAgree({term}, {});
}

TEST(UserTerm, FramesFarApartInTheCoarseSolveAreNeighboursThere) {
  const auto scene = MakeSequenceScene({});
  UserTerm term = OnLandmarks("far", {"nose"}, Neighbours().cost);
  term.inputs = Neighbours().inputs;
  for (TermInput& input : term.inputs) input.later *= 2;
  AddUserTerms(std::vector<UserTerm>{term}, &scene->problem);
  const SequenceProblem coarse = SelectFrames(scene->problem, {0, 2, 4});
  ASSERT_EQ(coarse.couplings.size(), 2U);
  EXPECT_EQ(coarse.couplings[1].frames, (std::vector<int>{1, 2}));
  EXPECT_GT(ChainProblem(scene->problem, false, false, 1).num_far_rows(), 0);
  EXPECT_EQ(ChainProblem(coarse, false, false, 1).num_far_rows(), 0);
}

TEST(UserTerm, MoreCouplingsThanChainTakesAreSolvedByCeres) {
  SynthClipOptions synth;
  synth.dense_per_frame = 0;
  const SynthClip clip = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 150, 15), synth);
  UserTerm term = Loop(BuiltinBody());
  term.cost = [](int) {
    return std::make_shared<ceres::AutoDiffCostFunction<ComesBack, 7, 3, 3, 3, 9, 9>>(new ComesBack);
  };
  const TrackSequenceSummary summary = TrackWith(clip, TrackSequenceOptions().solver, {term}).summary;
  EXPECT_TRUE(summary.IsUsable()) << summary.message;
  EXPECT_TRUE(std::any_of(summary.plan.begin(), summary.plan.end(),
                          [](const PlanEntry& entry) { return entry.what == "chain" && !entry.runs; }));
}

TEST(UserTerm, ReadsTheCameraFrameWhereTheCameraMoves) {
  // The same scene, once seen by a camera that stands still and once said of a camera that has moved: what a term of
  // one frame reads is what the camera sees, so costs are the same.
  for (const bool moves : {false, true}) {
    SequenceSceneOptions options;
    options.frames = 3;
    const auto scene = MakeSequenceScene(options);
    CameraPose pose;
    pose.camera_from_world_rotation = RotationFromAxisAngle(Vector3d(0.1, -0.4, 0.2));
    pose.camera_from_world_translation = Vector3d(0.3, 0.1, -0.2);
    SequenceProblem& problem = scene->problem;
    AddUserTerms(std::vector<UserTerm>{Pull(), Distance(), Seen(scene->body)}, &problem);
    if (moves) {
      for (size_t t = 0; t < problem.frames.size(); ++t) {
        problem.frames[t].camera_from_scene = &pose;
        problem.states[t] = StateInCamera(problem.layout, Inverse(pose), problem.betas, problem.states[t]);
      }
    }
    static double cost_of_still = 0;
    FrameEvaluator evaluator;
    FrameSystem system;
    double cost = 0;
    for (size_t t = 0; t < problem.frames.size(); ++t) {
      evaluator.Evaluate(problem.layout, problem.frames[t], problem.states[t], problem, true, &system);
      cost += system.cost;
    }
    if (!moves) cost_of_still = cost;
    EXPECT_GT(cost, 0);
    EXPECT_NEAR(cost, cost_of_still, 1e-9 * cost);
    SequenceProblem by_ceres = problem, by_chain = problem;
    SolveOptions solve;
    solve.function_tolerance = 1e-12;
    solve.max_iterations = 200;
    solve.solver = SequenceSolver::kCeres;
    const SolveReport ceres = SolveSequence(&by_ceres, solve);
    solve.solver = SequenceSolver::kChain;
    const SolveReport chain = SolveSequence(&by_chain, solve);
    EXPECT_NEAR(chain.final_cost, ceres.final_cost, 1e-6 * ceres.final_cost + 1e-9);
  }
}

TEST(UserTerm, ACostThatCannotBeEvaluatedIsAFailureNotACrash) {
  struct Never : ceres::SizedCostFunction<1, 3> {
    bool Evaluate(double const* const*, double*, double**) const override { return false; }
  };
  const auto term = OnLandmarks("never", {"nose"}, [](int) { return std::make_shared<Never>(); });
  for (SequenceSolver solver : {SequenceSolver::kCeres, SequenceSolver::kChain}) {
    const auto scene = MakeSequenceScene({});
    AddUserTerms(std::vector<UserTerm>{term}, &scene->problem);
    SolveOptions options;
    options.solver = solver;
    EXPECT_EQ(SolveSequence(&scene->problem, options).status, SolveStatus::kFailure);
  }
}

}  // namespace
}  // namespace bodyloom::user_term_test
