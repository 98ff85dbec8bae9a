// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/view_terms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tests/support/ceres_checks.h"
#include "tests/support/sequence_scene.h"
#include "tracking/problem/moving_camera.h"
#include "tracking/solvers/ceres_problem.h"
#include "tracking/solvers/chain/chain_problem.h"
#include "tracking/solvers/chain_solver.h"
#include "tracking/solvers/solve_sequence.h"
#include "tracking/solvers/term_costs.h"

namespace bodyloom::view_terms_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

struct TwoViews {
  std::unique_ptr<SequenceScene> scene;
  std::vector<ViewState> truth;
};

/// Pose of a camera that moves in frame t, from its own scene.
CameraPose PoseInFrame(int t) {
  return {RotationFromAxisAngle({0.02 * t, -0.05 * t, 0.3 + 0.01 * t}), Vector3d(0.05 * t - 0.2, 0.1, 0.03 * t)};
}

/// Adds views of the scene's landmarks and dense keypoints, whose clocks differ by 20 ms and 100 ppm. They move if
/// `move` says so.
TwoViews MakeViews(const SequenceSceneOptions& options, const std::vector<ViewUnknowns>& unknowns, double noise_px,
                   bool move = false) {
  TwoViews two{MakeSequenceScene(options), {}};
  SequenceProblem& problem = two.scene->problem;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const auto T = static_cast<int>(problem.frames.size());
  for (size_t v = 0; v < unknowns.size(); ++v) {
    const ViewUnknowns& view = unknowns[v];
    problem.layout.AddView(view);
    ViewState truth;
    const Vector3d turn = Vector3d(0.1, 0.9 - 2.2 * static_cast<double>(v), -0.15);
    truth.camera_from_scene.camera_from_world_rotation = RotationFromAxisAngle(turn);
    truth.camera_from_scene.camera_from_world_translation =
        Vector3d(0, 0, 4) - truth.camera_from_scene.camera_from_world_rotation * Vector3d(0, 0, 4) +
        Vector3d(0.2, -0.1, 0.3);
    truth.log_focal = std::log(1000.0);
    if (view.clock) {
      truth.offset_s = 0.02;
      truth.rate = 1e-4;
    }
    if (move) truth.camera_from_scene = Compose(Inverse(PoseInFrame(0)), truth.camera_from_scene);
    two.truth.push_back(truth);
    for (int t = 0; t < T; ++t) {
      ViewTerms terms;
      terms.view = static_cast<int>(v);
      terms.clock_s = (t - 0.5 * T) / 25.0;
      terms.sampled_s = 0.005;
      if (move) terms.camera_from_own = PoseInFrame(t);
      const FrameState in_view =
          StateInCamera(problem.layout, CameraOfView(terms, truth), two.scene->betas, two.scene->truth[t]);
      Kinematics kinematics;
      kinematics.Set(two.scene->body, two.scene->betas, in_view.rotations, in_view.translation, false);
      PointEvaluator points;
      auto& landmarks = terms.terms.Get<LandmarkTerm>();
      for (const CompiledPoint& point : two.scene->landmarks) {
        LandmarkObservation seen;
        seen.point = &point;
        seen.sigma_px = 4;
        if (!MakePinhole(1280, 720, 1000).Project(points.Evaluate(kinematics, point, false), &seen.pixel)) continue;
        seen.velocity_px_s = 60 * Vector2d{normal(random), normal(random)};
        const double shift = truth.offset_s + truth.rate * terms.clock_s - terms.sampled_s;
        seen.pixel +=
            noise_px * Vector2d{normal(random), normal(random)} - (view.clock ? shift : 0.0) * seen.velocity_px_s;
        if (!view.clock) terms.sampled_s = 0;
        landmarks.seen.push_back(seen);
      }
      terms.terms.Get<DenseTerm>().points = &two.scene->dense[t];  // wrong ones: outliers with a gradient
      terms.terms.Get<DenseTerm>().kernel = 30;
      problem.frames[t].views.push_back(std::move(terms));
    }
    ViewState start = truth;
    start.camera_from_scene.camera_from_world_rotation *= RotationFromAxisAngle(RandomTurn(0.05, &random));
    start.camera_from_scene.camera_from_world_translation += RandomTurn(0.1, &random);
    if (!view.pose) start.camera_from_scene = truth.camera_from_scene;
    if (view.knowledge == CameraKnowledge::kUnknownFocal) start.log_focal += 0.1;
    if (view.clock) start.offset_s = start.rate = 0;
    problem.views.push_back(start);
  }
  return two;
}

const ViewUnknowns kAll = {CameraKnowledge::kUnknownFocal, MakePinhole(1280, 720, 1000), true, true};
const ViewUnknowns kPoseOnly = {CameraKnowledge::kKnown, MakePinhole(1280, 720, 1000), true, false};
const ViewUnknowns kCalibrated = {CameraKnowledge::kKnown, MakePinhole(1280, 720, 1000), false, false};

/// Central differences of the whole problem's cost, in every shared unknown and some of the frames'.
void ExpectGradientOfTheCost(bool move, double log_ratio_sigma) {
  for (const CameraKnowledge first : {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal}) {
    SequenceSceneOptions options;
    options.knowledge = first;
    TwoViews two = MakeViews(options, {kAll, kPoseOnly, kCalibrated}, 2, move);
    SequenceProblem& problem = two.scene->problem;
    if (first == CameraKnowledge::kUnknownFocal) {
      problem.layout.views[0].log_ratio_prior = 0.07;
      problem.layout.views[0].log_ratio_sigma = log_ratio_sigma;
    }
    ChainProblem chain(problem, false, false, 1);
    const ChainPoint x(problem.states, problem);
    chain.Linearise(x);
    const VectorXd gradient = chain.gradient(), shared = chain.shared_gradient();
    ASSERT_EQ(shared.size(), problem.layout.num_betas + (first == CameraKnowledge::kUnknownFocal) + 9 + 6);
    const VectorXd none = VectorXd::Zero(gradient.size()), none_shared = VectorXd::Zero(shared.size());
    const auto cost_at = [&](const VectorXd& step, const VectorXd& shared_step) {
      ChainPoint y;
      chain.Plus(x, step, shared_step, &y);
      return chain.Cost(y);
    };
    constexpr double kStep = 1e-5;
    for (Eigen::Index i = 0; i < shared.size(); ++i) {
      const VectorXd d = kStep * VectorXd::Unit(shared.size(), i);
      const double numeric = (cost_at(none, d) - cost_at(none, -d)) / (2 * kStep);
      EXPECT_NEAR(shared[i], numeric, 1e-6 * shared.cwiseAbs().maxCoeff() + 1e-6 * std::abs(numeric)) << i;
    }
    for (Eigen::Index i = 0; i < chain.frame_size(); ++i) {
      const VectorXd d = kStep * VectorXd::Unit(gradient.size(), i);
      const double numeric = (cost_at(d, none_shared) - cost_at(-d, none_shared)) / (2 * kStep);
      EXPECT_NEAR(gradient[i], numeric, 1e-6 * gradient.cwiseAbs().maxCoeff()) << i;
    }
  }
}

TEST(ViewTerms, GradientIsThatOfTheCost) { ExpectGradientOfTheCost(false, 0); }
TEST(ViewTerms, GradientOfViewsThatMove) { ExpectGradientOfTheCost(true, 0); }
TEST(ViewTerms, GradientWithFocalLengthsAlike) { ExpectGradientOfTheCost(false, 1e-4); }

/// The matrix is JᵀJ of the residuals that Ceres gets one by one, and of the compressed ones.
void ExpectSameInCeres(bool move) {
  SequenceSceneOptions options;
  if (move) options.knowledge = CameraKnowledge::kUnknownFocal;
  TwoViews two = MakeViews(options, {kAll, kPoseOnly}, 2, move);
  SequenceProblem& problem = two.scene->problem;
  if (move) problem.layout.views[0].log_ratio_prior = 0.07, problem.layout.views[0].log_ratio_sigma = 1e-3;
  ChainProblem chain(problem, false, false, 2);
  const double expected = chain.Linearise(ChainPoint(problem.states, problem));
  VectorXd expected_gradient(chain.gradient().size() + chain.shared_gradient().size());
  expected_gradient << chain.gradient(), chain.shared_gradient();
  const auto table = CostsByTerm(problem, 1);
  const auto in_view = std::find_if(table.begin(), table.end(),
                                    [](const TermCosts& costs) { return costs.term == "2D joints, view 2"; });
  ASSERT_NE(in_view, table.end());
  for (const bool compress : {false, true}) {
    CeresProblem ceres(problem, {.num_threads = 2, .compress_frames = compress});
    ExpectCostAndGradient(&ceres.problem(), expected, expected_gradient);
    EXPECT_EQ(ceres.NameOf(ceres.view_blocks()[3]), "clock of view 2");
    if (compress) continue;
    const auto at = std::find(ceres.terms().begin(), ceres.terms().end(), "2D joints, view 2");
    ASSERT_NE(at, ceres.terms().end());
    EXPECT_NEAR(ceres.CostByTerm()[at - ceres.terms().begin()], in_view->cost, 1e-10 * in_view->cost);
  }
}

TEST(ViewTerms, CeresHasTheSameCostGradientAndTerms) { ExpectSameInCeres(false); }
TEST(ViewTerms, CeresHasTheSameOfViewsThatMoveAndFocalLengthsAlike) { ExpectSameInCeres(true); }

/// Both engines find the same minimum, and with exact observations the true camera, focal length and clock.
TEST(ViewTerms, BothEnginesFindTheView) {
  SequenceSceneOptions options;
  options.frames = 10;
  TwoViews two = MakeViews(options, {kAll}, 0);
  for (FrameData& frame : two.scene->problem.frames) frame.views[0].terms.Get<DenseTerm>().points = nullptr;
  SolveOptions solve;
  solve.max_iterations = 200;
  solve.function_tolerance = 1e-12;
  SequenceProblem by_chain = two.scene->problem, by_ceres = two.scene->problem;
  solve.solver = SequenceSolver::kChain;
  const SolveReport chain = SolveSequence(&by_chain, solve);
  solve.solver = SequenceSolver::kCeres;
  const SolveReport ceres = SolveSequence(&by_ceres, solve);
  EXPECT_NEAR(chain.final_cost, ceres.final_cost, 1e-6 * ceres.final_cost);
  for (const SequenceProblem* found : {&by_chain, &by_ceres}) {
    const ViewState &view = found->views[0], &truth = two.truth[0];
    EXPECT_LE(RotationAngleBetween(view.camera_from_scene.camera_from_world_rotation,
                                   truth.camera_from_scene.camera_from_world_rotation),
              0.02);
    EXPECT_LE(
        (view.camera_from_scene.camera_from_world_translation - truth.camera_from_scene.camera_from_world_translation)
            .norm(),
        0.15);
    EXPECT_NEAR(view.log_focal, truth.log_focal, 0.04);
    EXPECT_NEAR(view.offset_s, truth.offset_s, 0.004);
  }
}

/// A second view in the first one's place with its observations: everything counts twice.
TEST(ViewTerms, TheFirstViewAgainCountsTwice) {
  const auto scene = MakeSequenceScene({});
  SequenceProblem twice = scene->problem;
  twice.layout.AddView(kCalibrated);
  twice.views.emplace_back();
  for (FrameData& frame : twice.frames) {
    frame.views.emplace_back().terms.Get<LandmarkTerm>() = frame.Get<LandmarkTerm>();
  }
  SequenceProblem doubled = scene->problem;
  for (FrameData& frame : doubled.frames) {
    auto& seen = frame.Get<LandmarkTerm>().seen;
    const auto copy = seen;
    seen.insert(seen.end(), copy.begin(), copy.end());
  }
  ChainProblem a(twice, false, false, 1), b(doubled, false, false, 1);
  const double cost = b.Linearise(ChainPoint(doubled.states, doubled));
  EXPECT_NEAR(a.Linearise(ChainPoint(twice.states, twice)), cost, 1e-12 * cost);
  EXPECT_LE((a.gradient() - b.gradient()).norm(), 1e-10 * b.gradient().norm());
  EXPECT_LE((a.shared() - b.shared()).norm(), 1e-10 * b.shared().norm());
}

TEST(ViewTerms, WeakPerspectiveAndAHeldRootAreRefused) {
  const BodyModel body(ToyBodyData());
  FrameLayout weak = FrameLayout::Make(body, CameraKnowledge::kWeak, MakePinhole(64, 48, 50), {0, 1}, 2);
  EXPECT_THROW(weak.AddView(kAll), std::invalid_argument);
  FrameLayout held = FrameLayout::Make(body, CameraKnowledge::kKnown, MakePinhole(64, 48, 50), {1}, 2);
  EXPECT_THROW(held.AddView(kAll), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::view_terms_test
