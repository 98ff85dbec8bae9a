// SPDX-License-Identifier: Apache-2.0
// User cost functions in tracks: their effect, offline and live, and rejected functions.
#include <ceres/autodiff_cost_function.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "data_tools/synthesis/clips/demo_motion.h"
#include "tests/support/sequence_scene.h"
#include "tests/tracking/problem/user_term_kinds.h"
#include "tracking/live/track_live.h"
#include "tracking/problem/user_cost.h"

namespace bodyloom::user_term_track_test {
namespace {

using namespace user_term_kinds;
using Eigen::Vector3d;

TEST(UserTermTrack, MovesTheWristOfATrack) {
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

TEST(UserTermTrack, EstimatesTheJointsThatItReads) {
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

TEST(UserTermTrack, RefusalsNameTheTermInOneLine) {
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

TEST(UserTermTrack, MoreThanTheShapeIsRefusedWhereItIsHeld) {
  const auto scene = MakeSequenceScene({});
  scene->problem.layout =
      FrameLayout::Make(scene->body, CameraKnowledge::kKnown, scene->problem.layout.camera, AllJoints(scene->body), 0);
  scene->problem.betas.resize(0);
  EXPECT_THROW(AddUserTerms(std::vector<UserTerm>{Seen(scene->body)}, &scene->problem), std::invalid_argument);
}

TEST(UserTermTrack, LiveTrackingTakesTermsOfOneFrame) {
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

TEST(UserTermTrack, MovesTheWristLive) {
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
}  // namespace bodyloom::user_term_track_test
