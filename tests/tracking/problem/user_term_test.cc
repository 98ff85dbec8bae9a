// SPDX-License-Identifier: Apache-2.0
// Users' own cost functions: derivatives through the problem, both engines, what they do to a track, what is refused.
#include "tracking/problem/user_term.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/dynamic_autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/scene/camera_path.h"
#include "tests/support/dense_chain.h"
#include "tests/support/sequence_scene.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/live/track_live.h"
#include "tracking/problem/moving_camera.h"
#include "tracking/problem/user_cost.h"
#include "tracking/solvers/chain/chain_problem.h"
#include "tracking/solvers/solve_sequence.h"

namespace bodyloom::user_term_test {
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

UserTerm OnLandmarks(const std::string& name, const std::vector<std::string>& landmarks, UserTerm::CostOfFrame cost,
                     std::shared_ptr<ceres::LossFunction> loss = nullptr) {
  UserTerm term{.name = name, .cost = std::move(cost), .loss = std::move(loss)};
  for (const std::string& landmark : landmarks) term.inputs.push_back(TermInput::Landmark(landmark));
  return term;
}

UserTerm OnPose(const std::string& name, bool translation, const std::vector<int>& joints, UserTerm::CostOfFrame cost,
                std::shared_ptr<ceres::LossFunction> loss = nullptr) {
  UserTerm term{.name = name, .cost = std::move(cost), .loss = std::move(loss)};
  if (translation) term.inputs.push_back(TermInput::Translation());
  for (const int joint : joints) term.inputs.push_back(TermInput::Rotation(joint));
  return term;
}

UserTerm OnNeighbours(const std::string& name, const std::vector<std::string>& landmarks, UserTerm::CostOfFrame cost,
                      std::shared_ptr<ceres::LossFunction> loss = nullptr) {
  UserTerm term = OnLandmarks(name, landmarks, std::move(cost), std::move(loss));
  for (const std::string& landmark : landmarks) term.inputs.push_back(TermInput::Landmark(landmark, 1));
  return term;
}

/// A surface point that should be at a pixel, with the shape and the focal length in it: everything that a frame has.
struct SeenAt {
  Eigen::Vector2d pixel;
  template <typename T>
  bool operator()(T const* const* blocks, T* r) const {
    const T *x = blocks[0], *betas = blocks[1], *focal = blocks[2];
    r[0] = (focal[0] * x[0] / x[2] + 640.0 - pixel.x()) / 5.0;
    r[1] = (focal[0] * x[1] / x[2] + 360.0 - pixel.y()) / 5.0;
    r[2] = (betas[0] - 0.5) / 0.3;
    return true;
  }
};

UserTerm Seen(const BodyModel& body) {
  const int B = body.num_betas();
  UserTerm term{.name = "seen"};
  term.inputs = {TermInput::Surface({body.num_faces() / 3, Vector3d(0.2, 0.5, 0.3)}), TermInput::Betas(),
                 TermInput::FocalLength()};
  term.cost = [B](int t) {
    auto cost = std::make_shared<ceres::DynamicAutoDiffCostFunction<SeenAt>>(new SeenAt{{650.0 + 3 * t, 340.0}});
    for (const int size : {3, B, 1}) cost->AddParameterBlock(size);
    cost->SetNumResiduals(3);
    return cost;
  };
  return term;
}

/// A wrist comes back to where it was, two frames and five frames later, and as bent as it was.
struct ComesBack {
  template <typename T>
  bool operator()(const T* a, const T* b, const T* c, const T* R0, const T* R5, T* r) const {
    for (int i = 0; i < 3; ++i) r[i] = (a[i] - b[i]) / 0.5;
    for (int i = 0; i < 3; ++i) r[3 + i] = (a[i] - c[i]) / 0.5;
    r[6] = R0[5] - R5[5];
    return true;
  }
};

UserTerm Loop(const BodyModel& body, std::shared_ptr<ceres::LossFunction> loss = nullptr) {
  const int elbow = body.FindJoint("l_elbow");
  UserTerm term{.name = "loop", .loss = std::move(loss)};
  term.inputs = {TermInput::Landmark("left_wrist"), TermInput::Landmark("left_wrist", 2),
                 TermInput::Landmark("left_wrist", 5), TermInput::Rotation(elbow), TermInput::Rotation(elbow, 5)};
  term.cost = [](int t) -> std::shared_ptr<const ceres::CostFunction> {
    if (t > 2) return nullptr;
    return std::make_shared<ceres::AutoDiffCostFunction<ComesBack, 7, 3, 3, 3, 9, 9>>(new ComesBack);
  };
  return term;
}

UserTerm Pull(std::shared_ptr<ceres::LossFunction> loss = nullptr) {
  return OnLandmarks(
      "pull", {"left_wrist"},
      [](int t) -> std::shared_ptr<const ceres::CostFunction> {
        if (t == 1) return nullptr;
        return std::make_shared<ceres::AutoDiffCostFunction<PullTo, 3, 3>>(
            new PullTo{Vector3d(0.4, -0.3 + 0.02 * t, 3.5), 0.05});
      },
      std::move(loss));
}

UserTerm Distance() {
  return OnLandmarks("distance", {"left_wrist", "right_ankle"}, [](int) {
    return std::make_shared<ceres::AutoDiffCostFunction<Apart, 1, 3, 3>>(new Apart{0.9, 0.2});
  });
}

UserTerm Pose(const BodyModel& body, CameraKnowledge knowledge = CameraKnowledge::kKnown) {
  const Vector3d target = knowledge == CameraKnowledge::kWeak ? Vector3d(5.4, 0.2, -0.1) : Vector3d(0.2, 0.1, 3.8);
  return OnPose("alike", true, {body.FindJoint("l_elbow"), body.FindJoint("r_elbow")}, [target](int) {
    return std::make_shared<ceres::AutoDiffCostFunction<AlikeAndAt, 5, 3, 9, 9>>(new AlikeAndAt{target});
  });
}

UserTerm Neighbours(std::shared_ptr<ceres::LossFunction> loss = nullptr) {
  return OnNeighbours(
      "moves", {"left_wrist", "nose"},
      [](int) {
        return std::make_shared<ceres::AutoDiffCostFunction<Moves, 4, 3, 3, 3, 3>>(new Moves{Vector3d(0.03, 0.01, 0)});
      },
      std::move(loss));
}

std::vector<UserTerm> AllKinds(const BodyModel& body, CameraKnowledge knowledge) {
  return {Pull(std::make_shared<ceres::CauchyLoss>(2.0)),
          Distance(),
          Pose(body, knowledge),
          Neighbours(std::make_shared<ceres::HuberLoss>(1.5)),
          Seen(body),
          Loop(body, std::make_shared<ceres::CauchyLoss>(3.0))};
}

/// A clip of the built-in body from 2D joints, tracked by an engine with these terms.
TrackSequenceResult TrackWith(const SynthClip& clip, SequenceSolver solver, const std::vector<UserTerm>& terms) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.keypoints = &clip.keypoints;
  input.prior = &BuiltinPosePrior();
  input.camera = clip.truth.camera;
  TrackSequenceOptions options;
  options.solver = solver;
  options.user_terms = terms;
  return FitClip(input, options);
}

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
    const ChainPoint x{scene->problem.states, scene->problem.betas, scene->problem.log_focal};
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
      evaluator.Evaluate(problem.layout, problem.frames[t], problem.states[t], problem.betas, problem.log_focal, true,
                         &system);
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

TEST(UserTerm, MovesTheWristOfATrack) {
  SynthClipOptions options;
  options.dense_per_frame = 0;
  const SynthClip clip = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 12, 15), options);
  const TrackSequenceResult before = TrackWith(clip, SequenceSolver::kChain, {});
  ASSERT_TRUE(before.summary.IsUsable());
  const auto target = [&](int t) -> Vector3d {
    return Vector3d(before.track.coco17[t].row(9)) + Vector3d(0, -0.15, 0);
  };
  const auto term = OnLandmarks("wrist", {"left_wrist"}, [&](int t) {
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
    double sum = 0;
    for (const TermCost& cost : after.summary.costs) sum += cost.cost;
    EXPECT_NEAR(sum, after.summary.final_cost, 1e-9 * sum);
    EXPECT_TRUE(std::any_of(after.summary.costs.begin(), after.summary.costs.end(),
                            [](const TermCost& cost) { return cost.term == "wrist" && cost.cost > 0; }));
    EXPECT_TRUE(std::any_of(after.summary.plan.begin(), after.summary.plan.end(),
                            [](const PlanEntry& entry) { return entry.what == "term 'wrist'" && entry.runs; }));
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

TEST(UserTerm, EstimatesTheJointsThatItReads) {
  SynthClipOptions options;
  options.dense_per_frame = 0;
  const SynthClip clip = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 6, 15), options);
  const int hand = BuiltinBody().FindJoint("l_hand");
  ASSERT_GE(hand, 0);
  const Vector3d held = TrackWith(clip, SequenceSolver::kChain, {}).track.motion.poses.row(2).segment(3 * hand, 3);
  EXPECT_EQ(held.norm(), 0);
  const auto term = OnPose("hand", false, {hand},
                           [](int) { return std::make_shared<ceres::AutoDiffCostFunction<Bent, 1, 9>>(new Bent); });
  const Vector3d bent = TrackWith(clip, SequenceSolver::kChain, {term}).track.motion.poses.row(2).segment(3 * hand, 3);
  EXPECT_NEAR(bent.x(), -std::asin(0.3), 0.02);
}

std::string Refusal(const UserTerm& term) {
  const auto scene = MakeSequenceScene({});
  try {
    AddUserTerms(std::vector<UserTerm>{term}, &scene->problem);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(UserTerm, RefusalsNameTheTermInOneLine) {
  using testing::AllOf;
  using testing::HasSubstr;
  using testing::Not;
  const auto one_line = Not(HasSubstr("\n"));
  const auto cost = [](int) {
    return std::make_shared<ceres::AutoDiffCostFunction<PullTo, 3, 3>>(new PullTo{Vector3d::Zero(), 1});
  };
  EXPECT_THAT(Refusal(OnLandmarks("a", {"left_wrist", "nose"}, cost)),
              AllOf(HasSubstr("term 'a', frame 0"), HasSubstr("blocks of 3; expected blocks of 3, 3"), one_line));
  EXPECT_THAT(Refusal(OnNeighbours("b", {"nose"}, cost)), AllOf(HasSubstr("expected blocks of 3, 3"), one_line));
  EXPECT_THAT(Refusal(OnPose("c", false, {4}, cost)), AllOf(HasSubstr("expected blocks of 9"), one_line));
  EXPECT_THAT(Refusal(OnPose("d", false, {99}, cost)), AllOf(HasSubstr("'d': joint 99"), one_line));
  EXPECT_THAT(Refusal(OnPose("e", false, {-1}, cost)), AllOf(HasSubstr("joint -1"), one_line));
  EXPECT_THAT(Refusal(OnLandmarks("f", {"tail"}, cost)), AllOf(HasSubstr("no landmark 'tail'"), one_line));
  EXPECT_THAT(Refusal(OnLandmarks("g", {}, cost)), AllOf(HasSubstr("reads nothing"), one_line));
  EXPECT_THAT(Refusal(OnLandmarks("h", {"nose"}, nullptr)), AllOf(HasSubstr("no cost function"), one_line));
  EXPECT_EQ(Refusal(OnLandmarks("i", {"nose"}, cost)), "");
}

TEST(UserTerm, MoreThanTheShapeIsRefusedWhereItIsHeld) {
  const auto scene = MakeSequenceScene({});
  scene->problem.layout =
      FrameLayout::Make(scene->body, CameraKnowledge::kKnown, scene->problem.layout.camera, AllJoints(scene->body), 0);
  scene->problem.betas.resize(0);
  EXPECT_THROW(AddUserTerms(std::vector<UserTerm>{Seen(scene->body)}, &scene->problem), std::invalid_argument);
}

TEST(UserTerm, LiveTrackingTakesTermsOfOneFrame) {
  LiveTrackerOptions options;
  std::string why;
  options.solve.user_terms = {Pull()};
  EXPECT_TRUE(options.IsValid(&why)) << why;
  options.solve.user_terms = {Neighbours()};
  EXPECT_FALSE(options.IsValid(&why));
  EXPECT_THAT(why, testing::HasSubstr("the term 'moves' couples frames"));
  options.solve.user_terms.clear();
  options.solve.solver = SequenceSolver::kCeres;
  EXPECT_FALSE(options.IsValid(&why));
  EXPECT_THAT(why, testing::HasSubstr("chain engine, not by ceres"));
}

TEST(UserTerm, MovesTheWristLive) {
  SynthClipOptions synth;
  synth.dense_per_frame = 0;
  const SynthClip clip = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 12, 15), synth);
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.keypoints = &clip.keypoints;
  input.prior = &BuiltinPosePrior();
  input.camera = clip.truth.camera;
  LiveTrackerOptions options;
  const Track before = TrackLive(input, options).track;
  const auto target = [&](int t) -> Vector3d { return Vector3d(before.coco17[t].row(9)) + Vector3d(0, -0.15, 0); };
  options.solve.user_terms = {OnLandmarks("wrist", {"left_wrist"}, [&](int t) {
    return std::make_shared<ceres::AutoDiffCostFunction<PullTo, 3, 3>>(new PullTo{target(t), 0.02});
  })};
  const Track after = TrackLive(input, options).track;
  for (int t = 0; t < 12; ++t) EXPECT_LT((Vector3d(after.coco17[t].row(9)) - target(t)).norm(), 0.06) << t;
}

}  // namespace
}  // namespace bodyloom::user_term_test
