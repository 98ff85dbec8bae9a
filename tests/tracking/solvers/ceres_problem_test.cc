// SPDX-License-Identifier: Apache-2.0
// The ceres::Problem of a clip: cost, gradient and covariance equal to the chain engine's, by term and by name.
#include "tracking/solvers/ceres_problem.h"

#include <ceres/ceres.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/scene/camera_path.h"
#include "tests/support/ceres_checks.h"
#include "tests/support/sequence_scene.h"
#include "tracking/build_ceres_problem.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/problem/moving_camera.h"
#include "tracking/solvers/chain/chain_inverse.h"
#include "tracking/solvers/chain/chain_problem.h"
#include "tracking/solvers/solve_sequence.h"
#include "tracking/solvers/term_costs.h"
#include "tracking/track_sequence.h"

namespace bodyloom::ceres_problem_test {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

double SumOf(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// A clip with a cut, velocities and, where it is asked for, a camera that moves.
std::unique_ptr<SequenceScene> MakeClip(CameraKnowledge knowledge, bool moves, const CameraPose& pose) {
  SequenceSceneOptions options;
  options.frames = 8;
  options.knowledge = knowledge;
  auto scene = MakeSequenceScene(options);
  scene->problem.cut_before[5] = 1;
  scene->problem.velocity_weight = 2;
  for (size_t t = 0; moves && t < scene->problem.frames.size(); ++t) {
    SequenceProblem& problem = scene->problem;
    problem.frames[t].camera_from_scene = &pose;
    problem.states[t] = StateInCamera(problem.layout, Inverse(pose), problem.betas, problem.states[t]);
  }
  return scene;
}

TEST(CeresProblem, CostAndGradientAreTheChains) {
  CameraPose pose;
  pose.camera_from_world_rotation = RotationFromAxisAngle(Vector3d(0.2, -0.5, 0.1));
  pose.camera_from_world_translation = Vector3d(0.3, -0.2, 0.4);
  for (CameraKnowledge knowledge : {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    for (const bool moves : {false, true}) {
      if (moves && knowledge == CameraKnowledge::kWeak) continue;
      const auto scene = MakeClip(knowledge, moves, pose);
      SequenceProblem& problem = scene->problem;
      ChainProblem chain(problem, false, false, 2);
      const double expected = chain.Linearise(ChainPoint(problem.states, problem));
      VectorXd expected_gradient(chain.gradient().size() + chain.shared_gradient().size());
      expected_gradient << chain.gradient(), chain.shared_gradient();
      double by_term = 0;
      for (const TermCosts& term : CostsByTerm(problem, 2)) by_term += term.cost;
      EXPECT_NEAR(by_term, expected, 1e-10 * expected);
      for (const bool compress : {false, true}) {
        CeresProblem ceres(problem, {.num_threads = 2, .compress_frames = compress});
        ExpectCostAndGradient(&ceres.problem(), expected, expected_gradient);
        EXPECT_NEAR(SumOf(ceres.CostByTerm()), expected, 1e-10 * expected);
      }
    }
  }
}

TEST(CeresProblem, CostsOfTermsAreThoseOfTheTable) {
  const auto scene = MakeClip(CameraKnowledge::kUnknownFocal, false, {});
  CeresProblem ceres(scene->problem, {});
  const std::vector<double> costs = ceres.CostByTerm();
  const std::vector<TermCosts> table = CostsByTerm(scene->problem, 1);
  ASSERT_EQ(costs.size(), table.size());
  for (size_t i = 0; i < costs.size(); ++i) {
    const auto at = std::find(ceres.terms().begin(), ceres.terms().end(), table[i].term);
    ASSERT_NE(at, ceres.terms().end()) << table[i].term;
    EXPECT_NEAR(costs[at - ceres.terms().begin()], table[i].cost, 1e-10 * std::max(1.0, table[i].cost)) << *at;
  }
  EXPECT_THAT(ceres.terms(),
              testing::IsSupersetOf({"2D joints", "dense keypoints", "joint limits", "upright trunk", "smoothness",
                                     "velocity", "shape prior", "stature", "focal length prior"}));
}

TEST(CeresProblem, BlocksHaveNames) {
  const auto scene = MakeClip(CameraKnowledge::kUnknownFocal, false, {});
  CeresProblem ceres(scene->problem, {});
  const int knee = scene->body.FindJoint("l_knee");
  EXPECT_EQ(ceres.NameOf(ceres.rotation(3, knee)), "rotation of l_knee, frame 3");
  EXPECT_EQ(ceres.NameOf(ceres.translation(7)), "translation, frame 7");
  EXPECT_EQ(ceres.NameOf(ceres.betas()), "shape");
  EXPECT_EQ(ceres.NameOf(ceres.log_focal()), "logarithm of the focal length");
  const double elsewhere = 0;
  EXPECT_EQ(ceres.NameOf(&elsewhere), "");
  EXPECT_EQ(ceres.rotation(8, knee), nullptr);
  EXPECT_EQ(ceres.rotation(0, 999), nullptr);
  for (const CeresProblem::Block& block : ceres.residual_blocks()) {
    std::vector<double*> parameters;
    ceres.problem().GetParameterBlocksForResidualBlock(block.id, &parameters);
    for (const double* parameter : parameters) EXPECT_NE(ceres.NameOf(parameter), "");
  }
}

TEST(CeresProblem, AWeightIsOfItsTermAlone) {
  const auto scene = MakeClip(CameraKnowledge::kKnown, false, {});
  CeresProblem ceres(scene->problem, {});
  const std::vector<double> before = ceres.CostByTerm();
  const auto at = std::find(ceres.terms().begin(), ceres.terms().end(), "2D joints") - ceres.terms().begin();
  ceres.SetWeight("2D joints", 3);
  std::vector<double> after = ceres.CostByTerm();
  EXPECT_NEAR(after[at], 3 * before[at], 1e-10 * after[at]);
  after[at] = before[at];
  EXPECT_EQ(after, before);
  ceres.SetWeight("2D joints", 1);
  EXPECT_EQ(ceres.CostByTerm(), before);
  EXPECT_THROW(ceres.SetWeight("2D joint", 1), std::invalid_argument);
  EXPECT_THROW(ceres.SetWeight("2D joints", -1), std::invalid_argument);
  EXPECT_THROW(ceres.SetWeight("2D joints", NAN), std::invalid_argument);
}

TEST(CeresProblem, CovarianceIsTheChains) {
  SequenceSceneOptions options;
  options.frames = 5;
  options.outliers = 0;
  const auto scene = MakeSequenceScene(options);
  SequenceProblem& problem = scene->problem;
  SolveOptions solve;
  solve.max_iterations = 200;
  solve.function_tolerance = 1e-14;
  SolveSequence(&problem, solve);
  ChainProblem chain(problem, false, false, 1);
  chain.Linearise(ChainPoint(problem.states, problem));
  ChainFactor factor(chain.frame_size(), chain.shared_size(), chain.cut_before());
  MatrixXd P;
  ASSERT_TRUE(VisitCovariance(&chain, &factor, 2, 3, 1, [&](int, const MatrixXd& of_frame) { P = of_frame; }));
  CeresProblem ceres(problem, {});
  ceres::Covariance covariance{ceres::Covariance::Options()};
  double* translation = ceres.translation(2);
  const std::vector<std::pair<const double*, const double*>> wanted = {{translation, translation}};
  ASSERT_TRUE(covariance.Compute(wanted, &ceres.problem()));
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> by_ceres;
  covariance.GetCovarianceBlock(translation, translation, by_ceres.data());
  const int column = problem.layout.translation_column;
  EXPECT_LE((by_ceres - P.block<3, 3>(column, column)).norm(), 1e-5 * by_ceres.norm());
  EXPECT_GT(by_ceres.norm(), 0);
}

struct AtX {
  template <typename T>
  bool operator()(const T* x, T* r) const {
    r[0] = (x[0] - 0.4) / 1e-3;
    return true;
  }
};

TEST(CeresProblem, AUserMayAddAndFixAndSolve) {
  const auto scene = MakeSequenceScene({});
  SequenceProblem& problem = scene->problem;
  CeresProblem ceres(problem, {});
  ceres.problem().AddResidualBlock(new ceres::AutoDiffCostFunction<AtX, 1, 3>(new AtX), nullptr, ceres.translation(2));
  const Vector3d fixed = problem.states[4].translation;
  ceres.problem().SetParameterBlockConstant(ceres.translation(4));
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &ceres.problem(), &summary);
  ASSERT_TRUE(summary.IsSolutionUsable()) << summary.FullReport();
  EXPECT_LT(summary.final_cost, 0.5 * summary.initial_cost);
  ceres.CopyTo(&problem);
  EXPECT_NEAR(problem.states[2].translation.x(), 0.4, 0.01);
  EXPECT_EQ(problem.states[4].translation, fixed);
}

TEST(CeresProblem, WindowsLowerTheCostAsTheWholeDoesWithoutASeam) {
  SequenceSceneOptions scene_options;
  scene_options.frames = 320;
  scene_options.dense = 0;
  const auto scene = MakeSequenceScene(scene_options);
  SolveOptions options;
  options.num_threads = 2;
  options.max_iterations = 60;
  options.shape_constant = true;
  options.solver = SequenceSolver::kChain;
  options.function_tolerance = 1e-4;
  SolveSequence(&scene->problem, options);  // as the tracker: chain first
  options.function_tolerance = 1e-7;
  SequenceProblem whole = scene->problem, windows = scene->problem;
  options.solver = SequenceSolver::kCeres;
  const SolveReport of_whole = SolveSequence(&whole, options);
  options.max_frames_at_once = 210;
  const SolveReport of_windows = SolveSequence(&windows, options);
  EXPECT_NEAR(of_windows.initial_cost, of_whole.initial_cost, 1e-9 * of_whole.initial_cost);
  const double gain = of_whole.initial_cost - of_whole.final_cost;
  ASSERT_GT(gain, 0);
  EXPECT_NEAR(of_windows.final_cost, of_whole.final_cost, 0.2 * gain + 1e-5 * of_whole.final_cost);
  // The first window's last frame is 209; nothing jumps there.
  const auto smoothness = [](const SequenceProblem& problem, int begin, int end) {
    for (const TermCosts& term : CostsByTerm(problem, 1)) {
      if (term.term == "smoothness") return term.of_frame.segment(begin, end - begin).sum();
    }
    return 0.0;
  };
  for (const int seam : {110, 210}) {
    EXPECT_LT(smoothness(windows, seam - 2, seam + 4), 1.1 * smoothness(whole, seam - 2, seam + 4) + 0.01) << seam;
  }
}

TEST(ChainWindows, EndNearTheWholesAnswerWithoutASeam) {
  SequenceSceneOptions scene_options;
  scene_options.frames = 520;
  scene_options.dense = 0;
  const auto scene = MakeSequenceScene(scene_options);
  SolveOptions options;
  options.num_threads = 2;
  options.max_iterations = 60;
  options.solver = SequenceSolver::kChain;
  options.function_tolerance = 1e-7;
  SequenceProblem whole = scene->problem;
  const SolveReport of_whole = SolveSequence(&whole, options);
  // As the tracker: shape and focal length are known, the states are not.
  SequenceProblem windows = scene->problem;
  static_cast<SharedValues&>(windows) = whole;
  SequenceProblem same = windows;
  options.max_frames_at_once = 310;
  const SolveReport of_windows = SolveSequence(&windows, options);
  options.num_threads = 3;
  SolveSequence(&same, options);
  EXPECT_EQ(same.betas, windows.betas);
  EXPECT_EQ(same.log_focal, windows.log_focal);
  for (size_t t = 0; t < same.states.size(); ++t) {
    EXPECT_EQ(same.states[t].rotations, windows.states[t].rotations) << t;
    EXPECT_EQ(same.states[t].translation, windows.states[t].translation) << t;
  }
  EXPECT_EQ(of_windows.status, SolveStatus::kConverged);
  const auto cost_of = [](const SequenceProblem& problem) {
    double sum = 0;
    for (const TermCosts& term : CostsByTerm(problem, 1)) sum += term.cost;
    return sum;
  };
  EXPECT_NEAR(cost_of(whole), of_whole.final_cost, 1e-6 * of_whole.final_cost);
  EXPECT_LT(cost_of(windows), 1.01 * of_whole.final_cost);
  const auto smoothness = [](const SequenceProblem& problem, int begin, int end) {
    for (const TermCosts& term : CostsByTerm(problem, 1)) {
      if (term.term == "smoothness") return term.of_frame.segment(begin, end - begin).sum();
    }
    return 0.0;
  };
  for (const int seam : {210, 310}) {
    EXPECT_LT(smoothness(windows, seam - 2, seam + 4), 1.1 * smoothness(whole, seam - 2, seam + 4) + 0.01) << seam;
  }
}

TrackSequenceResult TrackDemo(const SynthClip& clip, SequenceSolver solver, int threads) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.keypoints = &clip.keypoints;
  input.prior = &BuiltinPosePrior();
  input.camera = clip.truth.camera;
  TrackSequenceOptions options;
  options.solver = solver;
  options.num_threads = threads;
  return FitClip(input, options);
}

TEST(CeresFinish, IsTheDefaultAndReportsItself) {
  SynthClipOptions synth;
  synth.dense_per_frame = 0;
  const SynthClip clip = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 60, 20), synth);
  const TrackSequenceResult result = TrackDemo(clip, TrackSequenceOptions().solver, 1);
  const TrackSequenceSummary& summary = result.summary;
  EXPECT_EQ(summary.solver, "chain+ceres");
  EXPECT_EQ(summary.status, SolveStatus::kConverged) << summary.message;
  EXPECT_TRUE(summary.ceres.ran);
  EXPECT_GE(summary.ceres.iterations, 1);
  EXPECT_EQ(summary.ceres.final_cost, summary.final_cost);
  EXPECT_LE(summary.ceres.final_cost, summary.ceres.initial_cost);
  EXPECT_GT(summary.ceres.gradient_max_norm, 0);
  double sum = 0, last = INFINITY;
  for (const TermCost& cost : summary.costs) {
    EXPECT_LE(cost.cost, last) << cost.term;
    sum += last = cost.cost;
  }
  EXPECT_NEAR(sum, summary.final_cost, 1e-9 * sum);
  ASSERT_TRUE(summary.worst_stretch.has_value());
  EXPECT_GE(summary.worst_stretch->cost_ratio, 1);
  EXPECT_NEAR(summary.worst_stretch->end_s - summary.worst_stretch->begin_s, 1, 0.051);
  EXPECT_FALSE(TrackDemo(clip, SequenceSolver::kChain, 1).summary.ceres.ran);
  const Track again = TrackDemo(clip, TrackSequenceOptions().solver, 3).track;
  EXPECT_EQ(again.motion.poses, result.track.motion.poses);
  EXPECT_EQ(again.motion.trans, result.track.motion.trans);
}

TEST(CeresFinish, TheProblemIsWhatTheTrackerSolves) {
  SynthClipOptions synth;
  synth.dense_per_frame = 0;
  const SynthClip clip = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 20, 20), synth);
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.keypoints = &clip.keypoints;
  input.prior = &BuiltinPosePrior();
  input.camera = clip.truth.camera;
  const TrackSequenceResult track = TrackSequence(input);
  const auto problem = BuildCeresProblem(input);
  ASSERT_NE(problem->blocks(), nullptr);
  EXPECT_NEAR(SumOf(problem->blocks()->CostByTerm()), track.summary.ceres.initial_cost,
              1e-9 * track.summary.ceres.initial_cost);
  const TrackSequenceResult unsolved = problem->Finish();
  EXPECT_EQ(unsolved.track.num_frames(), 20);
  EXPECT_EQ(unsolved.summary.num_parameters, track.summary.num_parameters);
}

}  // namespace
}  // namespace bodyloom::ceres_problem_test
