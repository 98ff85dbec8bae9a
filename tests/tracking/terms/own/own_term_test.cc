// SPDX-License-Identifier: Apache-2.0
// Users' own cost functions: derivatives through the problem, both engines, what they do to a track, what is refused.
#include "bodyloom/tracking/terms/own/own_term.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/data_tools/learned/pose_prior_io.h"
#include "bodyloom/data_tools/synthesis/clips/demo_motion.h"
#include "bodyloom/data_tools/synthesis/clips/synth_clip.h"
#include "bodyloom/tracking/chain/chain_problem.h"
#include "bodyloom/tracking/live/live_tracker.h"
#include "bodyloom/tracking/solve_sequence.h"
#include "bodyloom/tracking/terms/own/own_terms.h"
#include "bodyloom/tracking/track_sequence.h"
#include "tests/support/dense_chain.h"
#include "tests/support/sequence_scene.h"

namespace bodyloom {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// r = (x − target)/σ of a point or a translation.
struct PullTo {
  Vector3d target;
  double sigma;
  template <typename T>
  bool operator()(const T* x, T* r) const {
    for (int c = 0; c < 3; ++c) r[c] = (x[c] - target[c]) / sigma;
    return true;
  }
};

/// The distance of two points, which no linear residual can express.
struct Apart {
  double metres, sigma;
  template <typename T>
  bool operator()(const T* a, const T* b, T* r) const {
    const Eigen::Matrix<T, 3, 1> d(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    r[0] = (d.norm() - metres) / sigma;
    return true;
  }
};

/// The translation, and two joints bent like each other's mirror image, by two entries of their rotations.
struct AlikeAndAt {
  Vector3d target;
  template <typename T>
  bool operator()(const T* translation, const T* left, const T* right, T* r) const {
    for (int c = 0; c < 3; ++c) r[c] = (translation[c] - target[c]) / 0.1;
    r[3] = (left[1] + right[1]) / 0.1;
    r[4] = (left[5] - right[5]) / 0.1;  // entry (1, 2): row by row
    return true;
  }
};

/// Two landmarks of two frames: the first keeps its velocity, the second's distance to it does not change.
struct Moves {
  Vector3d step;
  template <typename T>
  bool operator()(const T* a0, const T* b0, const T* a1, const T* b1, T* r) const {
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> A0(a0), B0(b0), A1(a1), B1(b1);
    for (int c = 0; c < 3; ++c) r[c] = (A1[c] - A0[c] - step[c]) / 0.02;
    r[3] = ((A1 - B1).squaredNorm() - (A0 - B0).squaredNorm()) / 0.03;
    return true;
  }
};

OwnTerm Pull(std::shared_ptr<ceres::LossFunction> loss = nullptr) {
  return OwnTerm::OnLandmarks(
      "pull", {"left_wrist"},
      [](int t) -> std::shared_ptr<const ceres::CostFunction> {
        if (t == 1) return nullptr;
        return std::make_shared<ceres::AutoDiffCostFunction<PullTo, 3, 3>>(
            new PullTo{Vector3d(0.4, -0.3 + 0.02 * t, 3.5), 0.05});
      },
      std::move(loss));
}

OwnTerm Distance() {
  return OwnTerm::OnLandmarks("distance", {"left_wrist", "right_ankle"}, [](int) {
    return std::make_shared<ceres::AutoDiffCostFunction<Apart, 1, 3, 3>>(new Apart{0.9, 0.2});
  });
}

OwnTerm Pose(const BodyModel& body, CameraKnowledge knowledge = CameraKnowledge::kKnown) {
  const Vector3d target = knowledge == CameraKnowledge::kWeak ? Vector3d(5.4, 0.2, -0.1) : Vector3d(0.2, 0.1, 3.8);
  return OwnTerm::OnPose("alike", true, {body.FindJoint("l_elbow"), body.FindJoint("r_elbow")}, [target](int) {
    return std::make_shared<ceres::AutoDiffCostFunction<AlikeAndAt, 5, 3, 9, 9>>(new AlikeAndAt{target});
  });
}

OwnTerm Neighbours(std::shared_ptr<ceres::LossFunction> loss = nullptr) {
  return OwnTerm::OnNeighbours(
      "moves", {"left_wrist", "nose"},
      [](int) {
        return std::make_shared<ceres::AutoDiffCostFunction<Moves, 4, 3, 3, 3, 3>>(new Moves{Vector3d(0.03, 0.01, 0)});
      },
      std::move(loss));
}

std::vector<OwnTerm> AllKinds(const BodyModel& body, CameraKnowledge knowledge) {
  return {Pull(std::make_shared<ceres::CauchyLoss>(2.0)), Distance(), Pose(body, knowledge),
          Neighbours(std::make_shared<ceres::HuberLoss>(1.5))};
}

TEST(OwnTerm, DerivativesMatchDifferencesThroughTheProblem) {
  for (CameraKnowledge knowledge : {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    SequenceSceneOptions options;
    options.frames = 4;
    options.knowledge = knowledge;
    const auto scene = MakeSequenceScene(options);
    for (FrameData& frame : scene->problem.frames) frame = FrameData();  // own terms, smoothness and shape alone
    AddOwnTerms(AllKinds(scene->body, knowledge), &scene->problem);
    ASSERT_EQ(scene->problem.frames[1].own.costs.size(), 2U);
    ASSERT_EQ(scene->problem.frames[2].own.costs.size(), 3U);
    ASSERT_EQ(scene->problem.frames[2].own.with_next.size(), 1U);
    ASSERT_TRUE(scene->problem.frames[3].own.with_next.empty());
    ChainProblem chain(scene->problem, false, false, 2);
    const ChainPoint x{scene->problem.states, scene->problem.betas, scene->problem.log_focal};
    const int frames = 4 * chain.frame_size(), s = chain.shared_size();
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

TEST(OwnTerm, TheChainsMatrixHasTheCouplingOfNeighbours) {
  SequenceSceneOptions options;
  options.frames = 9;  // long enough for both directions of the elimination
  const auto scene = MakeSequenceScene(options);
  AddOwnTerms(AllKinds(scene->body, options.knowledge), &scene->problem);
  ChainProblem chain(scene->problem, false, false, 2);
  ASSERT_TRUE(std::isfinite(chain.Linearise({scene->problem.states, scene->problem.betas, scene->problem.log_focal})));
  MatrixXd H;
  VectorXd g;
  DenseSystem(chain, options.frames, &H, &g);
  const int n = chain.frame_size();
  EXPECT_GT(H.block(0, n, 3, 3).norm() + H.block(6, n, 3, n).norm(), 0);
  EXPECT_LE((H.diagonal().head(options.frames * n) - chain.diagonal()).norm(), 1e-9 * chain.diagonal().norm());
  const VectorXd damping = VectorXd::Constant(options.frames * n, 1e-3);
  chain.SetDamping(&damping);
  H.diagonal().head(options.frames * n) += damping;
  ChainFactor factor(n, chain.shared_size(), chain.cut_before());
  VectorXd step, shared_step;
  ASSERT_TRUE(factor.Solve(chain, chain.shared(), -chain.shared_gradient(), 2, &step, &shared_step));
  VectorXd x(step.size() + shared_step.size());
  x << step, shared_step;
  EXPECT_LE((H * x + g).norm(), 1e-8 * g.norm());
}

/// Costs to 1e-6; the answers differ from those without the terms.
void ExpectEnginesAgree(const std::vector<OwnTerm>& terms, SequenceSceneOptions scene_options) {
  const auto scene = MakeSequenceScene(scene_options);
  SolveOptions options;
  options.max_iterations = 300;
  options.function_tolerance = 1e-12;
  options.num_threads = 2;
  SequenceProblem without = scene->problem;
  SolveSequence(&without, options);
  AddOwnTerms(terms, &scene->problem);
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
  EXPECT_NEAR(reuse.final_cost, ceres.final_cost, 1e-6 * ceres.final_cost);
  double moved = 0;
  for (size_t t = 0; t < without.states.size(); ++t) {
    moved += (without.states[t].translation - by_chain.states[t].translation).norm();
  }
  EXPECT_GT(moved, 1e-4);
}

TEST(OwnTerm, BothEnginesAgreeOnEachKind) {
  const BodyModel body(ToyBodyData());
  const SequenceSceneOptions options;
  ExpectEnginesAgree({Pull()}, options);
  ExpectEnginesAgree({Pull(std::make_shared<ceres::CauchyLoss>(2.0))}, options);
  ExpectEnginesAgree({Distance()}, options);
  ExpectEnginesAgree({Pose(body)}, options);
  ExpectEnginesAgree({Neighbours()}, options);
  ExpectEnginesAgree({Neighbours(std::make_shared<ceres::HuberLoss>(1.5))}, options);
}

TEST(OwnTerm, BothEnginesAgreeInEveryCameraAndLength) {
  const BodyModel body(ToyBodyData());
  for (CameraKnowledge knowledge : {CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    SequenceSceneOptions options;
    options.knowledge = knowledge;
    ExpectEnginesAgree({Distance(), Pose(body, knowledge), Neighbours()}, options);
  }
  for (const int frames : {2, 3, 11}) {
    SequenceSceneOptions options;
    options.frames = frames;
    ExpectEnginesAgree({Pull(), Neighbours()}, options);
  }
}

TEST(OwnTerm, NeighboursDoNotReachAcrossACut) {
  const auto scene = MakeSequenceScene({});
  scene->problem.cut_before[3] = 1;
  AddOwnTerms(std::vector<OwnTerm>{Neighbours()}, &scene->problem);
  EXPECT_FALSE(scene->problem.frames[1].own.with_next.empty());
  EXPECT_TRUE(scene->problem.frames[2].own.with_next.empty());
  const SequenceProblem some = SelectFrames(scene->problem, {0, 1, 4});
  EXPECT_FALSE(some.frames[0].own.with_next.empty());
  EXPECT_TRUE(some.frames[1].own.with_next.empty());
  EXPECT_TRUE(some.frames[2].own.with_next.empty());
}

TEST(OwnTerm, ACostThatCannotBeEvaluatedIsAFailureNotACrash) {
  struct Never : ceres::SizedCostFunction<1, 3> {
    bool Evaluate(double const* const*, double*, double**) const override { return false; }
  };
  const auto term = OwnTerm::OnLandmarks("never", {"nose"}, [](int) { return std::make_shared<Never>(); });
  for (SequenceSolver solver : {SequenceSolver::kCeres, SequenceSolver::kChain}) {
    const auto scene = MakeSequenceScene({});
    AddOwnTerms(std::vector<OwnTerm>{term}, &scene->problem);
    SolveOptions options;
    options.solver = solver;
    EXPECT_EQ(SolveSequence(&scene->problem, options).status, SolveStatus::kFailure);
  }
}

/// A clip of the built-in body from 2D joints, tracked by an engine with these terms.
TrackSequenceResult TrackWith(const SynthClip& clip, SequenceSolver solver, const std::vector<OwnTerm>& terms) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.keypoints = &clip.keypoints;
  input.prior = &BuiltinPosePrior();
  input.camera = clip.truth.camera;
  TrackSequenceOptions options;
  options.solver = solver;
  options.own_terms = terms;
  return TrackSequence(input, options);
}

TEST(OwnTerm, MovesTheWristOfATrack) {
  SynthClipOptions options;
  options.dense_per_frame = 0;
  const SynthClip clip = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 12, 15), options);
  const TrackSequenceResult before = TrackWith(clip, SequenceSolver::kChain, {});
  ASSERT_TRUE(before.summary.IsUsable());
  EXPECT_TRUE(before.summary.own_terms.empty());
  const auto target = [&](int t) -> Vector3d {
    return Vector3d(before.track.coco17[t].row(9)) + Vector3d(0, -0.15, 0);
  };
  const auto term = OwnTerm::OnLandmarks("wrist", {"left_wrist"}, [&](int t) {
    return std::make_shared<ceres::AutoDiffCostFunction<PullTo, 3, 3>>(new PullTo{target(t), 0.02});
  });
  for (SequenceSolver solver : {SequenceSolver::kChain, SequenceSolver::kCeres}) {
    const TrackSequenceResult after = TrackWith(clip, solver, {term});
    ASSERT_TRUE(after.summary.IsUsable()) << after.summary.message;
    for (int t = 0; t < 12; ++t) {
      EXPECT_LT((Vector3d(after.track.coco17[t].row(9)) - target(t)).norm(), 0.05) << t;
      // The other side's ankle stays where it was seen (its depth hardly is).
      EXPECT_LT((after.track.coco17[t].row(16) - before.track.coco17[t].row(16)).head(2).norm(), 0.05) << t;
    }
    ASSERT_EQ(after.summary.own_terms.size(), 1U);
    EXPECT_EQ(after.summary.own_terms[0].name, "wrist");
    EXPECT_EQ(after.summary.own_terms[0].num_costs, 12);
    EXPECT_GT(after.summary.own_terms[0].cost, 0);
    EXPECT_TRUE(std::any_of(after.summary.plan.begin(), after.summary.plan.end(),
                            [](const PlanEntry& entry) { return entry.what == "own term 'wrist'" && entry.runs; }));
  }
}

/// Entry (1, 2) of a rotation.
struct Bent {
  template <typename T>
  bool operator()(const T* R, T* r) const {
    r[0] = (R[5] - 0.3) / 0.01;
    return true;
  }
};

TEST(OwnTerm, EstimatesTheJointsThatItReads) {
  SynthClipOptions options;
  options.dense_per_frame = 0;
  const SynthClip clip = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 6, 15), options);
  const int hand = BuiltinBody().FindJoint("l_hand");
  ASSERT_GE(hand, 0);
  const Vector3d held = TrackWith(clip, SequenceSolver::kChain, {}).track.motion.poses.row(2).segment(3 * hand, 3);
  EXPECT_EQ(held.norm(), 0);
  const auto term = OwnTerm::OnPose(
      "hand", false, {hand}, [](int) { return std::make_shared<ceres::AutoDiffCostFunction<Bent, 1, 9>>(new Bent); });
  const Vector3d bent = TrackWith(clip, SequenceSolver::kChain, {term}).track.motion.poses.row(2).segment(3 * hand, 3);
  EXPECT_NEAR(bent.x(), -std::asin(0.3), 0.02);
}

std::string Refusal(const OwnTerm& term) {
  const auto scene = MakeSequenceScene({});
  try {
    AddOwnTerms(std::vector<OwnTerm>{term}, &scene->problem);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(OwnTerm, RefusalsNameTheTermInOneLine) {
  using testing::AllOf;
  using testing::HasSubstr;
  using testing::Not;
  const auto one_line = Not(HasSubstr("\n"));
  const auto cost = [](int) {
    return std::make_shared<ceres::AutoDiffCostFunction<PullTo, 3, 3>>(new PullTo{Vector3d::Zero(), 1});
  };
  EXPECT_THAT(Refusal(OwnTerm::OnLandmarks("a", {"left_wrist", "nose"}, cost)),
              AllOf(HasSubstr("own term 'a', frame 0"), HasSubstr("blocks of 3; expected blocks of 3, 3"), one_line));
  EXPECT_THAT(Refusal(OwnTerm::OnNeighbours("b", {"nose"}, cost)),
              AllOf(HasSubstr("expected blocks of 3, 3"), one_line));
  EXPECT_THAT(Refusal(OwnTerm::OnPose("c", false, {4}, cost)), AllOf(HasSubstr("expected blocks of 9"), one_line));
  EXPECT_THAT(Refusal(OwnTerm::OnPose("d", false, {99}, cost)), AllOf(HasSubstr("'d': joint 99"), one_line));
  EXPECT_THAT(Refusal(OwnTerm::OnPose("e", false, {-1}, cost)), AllOf(HasSubstr("joint -1"), one_line));
  EXPECT_THAT(Refusal(OwnTerm::OnLandmarks("f", {"tail"}, cost)), AllOf(HasSubstr("no landmark 'tail'"), one_line));
  EXPECT_THAT(Refusal(OwnTerm::OnLandmarks("g", {}, cost)), AllOf(HasSubstr("reads nothing"), one_line));
  EXPECT_THAT(Refusal(OwnTerm::OnLandmarks("h", {"nose"}, nullptr)), AllOf(HasSubstr("no cost function"), one_line));
  EXPECT_EQ(Refusal(OwnTerm::OnLandmarks("i", {"nose"}, cost)), "");
}

TEST(OwnTerm, LiveTrackingSaysThatItHasNone) {
  LiveTrackerOptions options;
  std::string why;
  EXPECT_TRUE(options.IsValid(&why));
  options.solve.own_terms = {Pull()};
  EXPECT_FALSE(options.IsValid(&why));
  EXPECT_THAT(why, testing::HasSubstr("'pull' cannot run live"));
  options.solve.own_terms.clear();
  options.solve.solver = SequenceSolver::kCeres;
  EXPECT_FALSE(options.IsValid(&why));
  EXPECT_THAT(why, testing::HasSubstr("chain engine, not by ceres"));
}

}  // namespace
}  // namespace bodyloom
