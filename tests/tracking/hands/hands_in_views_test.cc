// SPDX-License-Identifier: Apache-2.0
#include "tracking/hands/hands_in_views.h"

#include <gtest/gtest.h>

#include "data_tools/body/builtin_body.h"
#include "geometry/scene/camera_path.h"
#include "tests/support/synthetic_hands.h"
#include "tracking/hands/fit_hands.h"

namespace bodyloom::hands_in_views_test {
namespace {

/// A rig of two cameras, the first of which sees the left hand in eight frames, the second one both hands in all 20.
struct TwoCameras {
  TwoCameras() : seen_by_second(MakeSyntheticHands({.pose = "pointing", .frames = 20})) {
    RigCamera first;
    first.camera = MakePinhole(1000, 1000, 900);
    first.camera_from_rig.camera_from_world_rotation = RotationFromAxisAngle({0.1, -0.7, 0.05});
    first.camera_from_rig.camera_from_world_translation = {1.5, 0.1, 0.8};
    second.name = "right";
    second.camera = seen_by_second.track.camera;
    second.camera_from_rig = Inverse(first.camera_from_rig);
    second.offset_s = 0.2;
    first.offset_s = 0;
    result.track = TrackSeenBy(first, BuiltinBodyWithHands(), seen_by_second.track);
    result.summary.status = SolveStatus::kConverged;
    views.resize(2);
    views[1].camera = second;
    for (HandsOfView& view : views) view.seen = seen_by_second.seen;
    for (size_t t = 0; t < 20; ++t) {
      auto left = std::make_shared<HandsAndFace>(*views[0].seen.frames[t]);
      left->hands[HandsAndFace::kRight].reset();
      views[0].seen.frames[t] = t < 8 ? left : nullptr;
    }
  }

  SyntheticHands seen_by_second;
  RigCamera second;
  TrackSequenceResult result;
  std::vector<HandsOfView> views;
};

TEST(HandsInViews, EachHandIsThatOfTheCameraThatShowsItMost) {
  TwoCameras rig;
  const Track before = rig.result.track;
  Track alone = rig.seen_by_second.track;
  FitHands(BuiltinBodyWithHands(), rig.seen_by_second.seen, {}, {}, 1, &alone);
  FitHandsInViews(BuiltinBodyWithHands(), rig.views, {}, 2, &rig.result);
  const Track& track = rig.result.track;
  int changed = 0;
  for (int j = 1; j < BuiltinBodyWithHands().num_joints(); ++j) {
    const auto own = track.motion.poses.middleCols<3>(3 * j);
    const auto other = alone.motion.poses.middleCols<3>(3 * j);
    EXPECT_LT((own - other).norm(), 1e-6) << j;
    changed += own == before.motion.poses.middleCols<3>(3 * j) ? 0 : 1;
  }
  EXPECT_EQ(changed, 2 * 17) << "elbows, wrists, fingers";
  EXPECT_EQ(track.motion.trans, before.motion.trans);
  EXPECT_EQ(track.motion.poses.leftCols(3), before.motion.poses.leftCols(3));
  EXPECT_LT((track.joint_sigma - alone.joint_sigma).norm(), 1e-6);
  const BodyPose pose = PoseFromAxisAngle(BuiltinBodyWithHands(), track.motion.poses.row(7), track.motion.trans.row(7));
  const MatrixX3d rest = BuiltinBodyWithHands().RestJoints({});
  EXPECT_LT((PoseSkeleton(BuiltinBodyWithHands(), rest, pose).joints - track.joints[7]).norm(), 1e-9);
  ASSERT_EQ(rig.result.summary.hands.size(), 2U);
  EXPECT_EQ(rig.result.summary.hands[0].why, "right: seen in 20 of 20 frames, 55 px long");
  EXPECT_EQ(rig.result.summary.head->why, "no face is seen");
  ASSERT_EQ(rig.result.summary.plan.size(), 2U);
  EXPECT_TRUE(rig.result.summary.plan[0].runs);
}

TEST(HandsInViews, AHandThatTheSecondCameraLosesIsTheFirstOnes) {
  TwoCameras rig;
  rig.views[0].seen = rig.seen_by_second.seen;
  for (auto& frame : rig.views[0].seen.frames) frame = nullptr;
  for (size_t t = 0; t < 20; ++t) {
    auto right = std::make_shared<HandsAndFace>(*rig.views[1].seen.frames[t]);
    right->hands[HandsAndFace::kLeft].reset();
    rig.views[1].seen.frames[t] = right;
  }
  FitHandsInViews(BuiltinBodyWithHands(), rig.views, {}, 1, &rig.result);
  EXPECT_FALSE(rig.result.summary.hands[0].ran);
  EXPECT_EQ(rig.result.summary.hands[0].why, "no hand is seen");
  EXPECT_TRUE(rig.result.summary.hands[1].ran);
}

TEST(HandsInViews, ThePlanNamesTheReason) {
  const TwoCameras rig;
  const std::vector<PlanEntry> plan = PlanHandsInViews(BuiltinBodyWithHands(), rig.views);
  ASSERT_EQ(plan.size(), 2U);
  EXPECT_TRUE(plan[0].runs);
  EXPECT_EQ(plan[0].why, "fingers, wrists and forearms, after the body, each by the view that shows it most");
  EXPECT_FALSE(plan[1].runs);
  EXPECT_EQ(plan[1].why, "no face is seen");
  EXPECT_TRUE(PlanHandsInViews(BuiltinBody(), {{}, {}}).empty());
}

}  // namespace
}  // namespace bodyloom::hands_in_views_test
