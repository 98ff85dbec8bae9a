// SPDX-License-Identifier: Apache-2.0
#include "tracking/hands/fit_hands.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "geometry/biomechanics/hand_prior.h"
#include "tests/support/synthetic_hands.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/people/track_people.h"

namespace bodyloom::fit_hands_test {
namespace {

constexpr double kDegree = M_PI / 180;

HandSkeleton HandOfSide(size_t side) {
  return FindHand(BuiltinBodyWithHands(), side == 0 ? HandSide::kLeft : HandSide::kRight).value();
}

HandAngleVector AnglesAt(const Track& track, const HandSkeleton& hand, int t) {
  HandAngleVector angles;
  for (int j = 0; j < kHandJoints; ++j) {
    const Eigen::Vector3d w = track.motion.poses.row(t).segment<3>(3 * hand.joint[j]);
    angles.segment<3>(3 * j) = HandAngles(hand, j, RotationFromAxisAngle(w));
  }
  return angles;
}

TEST(FitHands, FindsFingersOfEveryPoseFromAllSides) {
  for (const auto& [pose, keys] : SyntheticHandPoses()) {
    for (const double yaw : {0.0, 60.0, 180.0}) {
      const FingerErrors errors =
          FitSyntheticHands(MakeSyntheticHands({.pose = pose, .yaw_deg = yaw, .frames = FramesOf(pose)}), {}, 15);
      for (size_t f = 0; f < 5; ++f)
        EXPECT_LT(errors.mean_deg[f], 15) << pose << " at " << yaw << ", " << FingerNames()[f];
    }
  }
}

TEST(FitHands, SigmaIsOfTheSizeOfTheErrors) {
  double within_one = 0, within_two = 0;
  int clips = 0;
  for (const char* pose : {"flat", "fist", "pinch", "counting"}) {
    for (const unsigned seed : {1U, 2U}) {
      const FingerErrors errors =
          FitSyntheticHands(MakeSyntheticHands({.pose = pose, .yaw_deg = 60, .seed = seed}), {}, 5);
      within_one += errors.within_one, within_two += errors.within_two;
      ++clips;
    }
  }
  EXPECT_GT(within_one / clips, 0.5) << "0.68 of a Gaussian";
  EXPECT_LT(within_one / clips, 0.9);
  EXPECT_GT(within_two / clips, 0.85) << "0.95 of a Gaussian";
}

TEST(FitHands, WithoutNoiseNothingButThePriorIsLeft) {
  const FingerErrors errors = FitSyntheticHands(MakeSyntheticHands({.pose = "pinch", .noise = 0}), {}, 15);
  for (const double mean : errors.mean_deg) EXPECT_LT(mean, 8) << "the stated sigma leave the prior its part";
}

TEST(FitHands, AnUnseenHandRestsWithTheWidthOfThePrior) {
  SyntheticHands made = MakeSyntheticHands({.pose = "fist", .frames = 90, .unseen_from = 20});
  const Track before = made.track;
  const auto summaries = FitHands(BuiltinBodyWithHands(), made.seen, {}, {}, 2, &made.track);
  EXPECT_EQ(summaries[0].frames_seen, 20);
  EXPECT_EQ(summaries[1].why, "seen in 20 of 90 frames, 55 px long");
  const HandPrior& prior = BuiltinHandPrior();
  for (size_t side = 0; side < 2; ++side) {
    const HandSkeleton hand = HandOfSide(side);
    const HandAngleVector last = AnglesAt(made.track, hand, 89);
    for (const int angle : FreeHandAngles()) EXPECT_NEAR(last[angle], prior.mean[angle], 6 * kDegree) << angle;
    const Eigen::Vector3d wrist = made.track.motion.poses.row(89).segment<3>(3 * hand.wrist);
    EXPECT_LT((wrist.transpose() - before.motion.poses.row(89).segment<3>(3 * hand.wrist)).norm(), 0.05);
    // The σ of the last joints: wide where nothing is seen.
    EXPECT_GT(made.track.joint_sigma(89, hand.joint[2]), 1.5 * made.track.joint_sigma(10, hand.joint[2]));
    EXPECT_GT(made.track.joint_sigma(89, hand.joint[2]), 0.04);
    EXPECT_LT(made.track.joint_sigma(10, hand.joint[2]), 0.03);
  }
}

TEST(FitHands, ChangesNothingButHandsAndForearms) {
  SyntheticHands made = MakeSyntheticHands({.pose = "pointing", .frames = 12});
  const Track before = made.track;
  FitHands(BuiltinBodyWithHands(), made.seen, {}, {}, 1, &made.track);
  std::set<int> fingers, turned;
  for (size_t side = 0; side < 2; ++side) {
    const HandSkeleton hand = HandOfSide(side);
    fingers.insert(hand.joint.begin(), hand.joint.end());
    turned.insert({hand.wrist, BuiltinBodyWithHands().parents()[hand.wrist]});
  }
  int moved = 0;
  for (int t = 0; t < 12; ++t) {
    for (int j = 0; j < BuiltinBodyWithHands().num_joints(); ++j) {
      const bool of_hand = fingers.count(j) > 0 || turned.count(j) > 0;
      const bool same =
          made.track.motion.poses.row(t).segment<3>(3 * j) == before.motion.poses.row(t).segment<3>(3 * j);
      EXPECT_TRUE(of_hand || same) << j;
      moved += same ? 0 : 1;
      if (fingers.count(j) == 0) {
        EXPECT_EQ(made.track.joints[t].row(j), before.joints[t].row(j)) << j;
      }
    }
    for (int k : {0, 5, 6, 11, 16}) EXPECT_EQ(made.track.coco17[t].row(k), before.coco17[t].row(k)) << k;
    const BodyPose pose =
        PoseFromAxisAngle(BuiltinBodyWithHands(), made.track.motion.poses.row(t), made.track.motion.trans.row(t));
    const MatrixX3d joints = PoseSkeleton(BuiltinBodyWithHands(), BuiltinBodyWithHands().RestJoints({}), pose).joints;
    EXPECT_LT((joints - made.track.joints[t]).norm(), 1e-9) << "joints are those of the pose";
  }
  EXPECT_EQ(made.track.motion.trans, before.motion.trans);
  EXPECT_EQ(moved, 12 * 2 * 17);
}

/// The track on the body of 24 joints.
Track WithoutFingers(const Track& track) {
  Track body = track;
  const int T = track.num_frames();
  body.motion.body = BuiltinBody().name();
  body.motion.poses = RowMatrixXd::Zero(T, 72);
  body.motion.poses.leftCols(66) = track.motion.poses.leftCols(66);
  body.joint_sigma = track.joint_sigma.leftCols(24);
  for (int t = 0; t < T; ++t) {
    const BodyPose pose = PoseFromAxisAngle(BuiltinBody(), body.motion.poses.row(t), body.motion.trans.row(t));
    body.joints[t] = PoseSkeleton(BuiltinBody(), BuiltinBody().RestJoints({}), pose).joints;
  }
  return body;
}

TEST(FitHands, FingersAreGivenToATrackThatStaysAsItIs) {
  const SyntheticHands made = MakeSyntheticHands({.pose = "flat", .frames = 4});
  Track before = WithoutFingers(made.track);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  before.motion.poses.row(2).setConstant(nan), before.motion.trans.row(2).setConstant(nan);
  before.joints[2].setConstant(nan);
  before.joint_sigma.col(20).setConstant(0.03);  // of the left wrist
  Track track = before;
  const BodyModel& body = BuiltinBodyWithHands();
  GiveFingers(body, &track);
  EXPECT_EQ(track.motion.body, body.name());
  ASSERT_EQ(track.motion.poses.cols(), 3 * body.num_joints());
  for (const int t : {0, 1, 3}) {
    EXPECT_EQ(track.motion.poses.row(t).head(66), before.motion.poses.row(t).head(66));
    EXPECT_EQ(track.joints[t].topRows(22), before.joints[t].topRows(22));
    EXPECT_EQ(track.coco17[t], before.coco17[t]);
    const BodyPose pose = PoseFromAxisAngle(body, track.motion.poses.row(t), track.motion.trans.row(t));
    EXPECT_LT((PoseSkeleton(body, body.RestJoints({}), pose).joints - track.joints[t]).norm(), 1e-9);
    for (size_t side = 0; side < 2; ++side) {
      const HandSkeleton hand = HandOfSide(side);
      const HandAngleVector angles = AnglesAt(track, hand, t);
      for (const int angle : FreeHandAngles()) EXPECT_NEAR(angles[angle], BuiltinHandPrior().mean[angle], 1e-6);
      for (const int joint : hand.joint) EXPECT_EQ(track.joint_sigma(t, joint), side == 0 ? 0.03 : 0.02);
    }
  }
  EXPECT_FALSE(track.motion.HasPose(2)) << "lost frames stay lost";
  EXPECT_TRUE(track.joints[2].array().isNaN().all());
  EXPECT_THROW(GiveFingers(body, &track), std::invalid_argument) << "it has them already";
  EXPECT_THROW(GiveFingers(BuiltinBody(), &before), std::invalid_argument);
}

TEST(FitHands, SameBytesForAnyNumberOfThreads) {
  SyntheticHands one = MakeSyntheticHands({.pose = "counting", .frames = 20}), two = one;
  FitHands(BuiltinBodyWithHands(), one.seen, {}, {}, 1, &one.track);
  FitHands(BuiltinBodyWithHands(), two.seen, {}, {}, 4, &two.track);
  EXPECT_EQ(one.track.motion.poses, two.track.motion.poses);
  EXPECT_EQ(one.track.joint_sigma, two.track.joint_sigma);
}

TEST(FitHands, WindowsLeaveNoSeam) {
  constexpr int kFrames = 120, kWindow = 40;
  SyntheticHands whole = MakeSyntheticHands({.pose = "counting", .frames = kFrames}), windows = whole;
  HandFitOptions options;
  options.max_iterations = 100;
  FitHands(BuiltinBodyWithHands(), whole.seen, {}, options, 1, &whole.track);
  options.max_frames = 100, options.window_frames = kWindow, options.context_s = 1.5;
  const auto summaries = FitHands(BuiltinBodyWithHands(), windows.seen, {}, options, 1, &windows.track);
  EXPECT_EQ(summaries[0].frames_seen, kFrames);
  const RowMatrixXd apart = (windows.track.motion.poses - whole.track.motion.poses).cwiseAbs();
  double at_seams = 0;
  for (int t = kWindow; t < kFrames; t += kWindow) {
    const Eigen::RowVectorXd step = windows.track.motion.poses.row(t) - windows.track.motion.poses.row(t - 1);
    const Eigen::RowVectorXd expected = whole.track.motion.poses.row(t) - whole.track.motion.poses.row(t - 1);
    at_seams = std::max(at_seams, (step - expected).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(at_seams, 0.5 * kDegree);
  EXPECT_LT(apart.maxCoeff(), 2 * kDegree);
}

TEST(FitHands, LostFramesStayLost) {
  SyntheticHands made = MakeSyntheticHands({.pose = "flat", .frames = 12});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const int t : {0, 5, 6}) {
    made.track.motion.poses.row(t).setConstant(nan), made.track.motion.trans.row(t).setConstant(nan);
  }
  FitHands(BuiltinBodyWithHands(), made.seen, {}, {}, 1, &made.track);
  for (int t = 0; t < 12; ++t) EXPECT_EQ(made.track.motion.HasPose(t), t != 0 && t != 5 && t != 6);
}

TEST(FitHands, SaysWhyNot) {
  SyntheticHands made = MakeSyntheticHands({.frames = 4});
  const BodyModel& body = BuiltinBodyWithHands();
  EXPECT_EQ(WhyNoHands(body, &made.seen), "");
  EXPECT_EQ(WhyNoHands(body, nullptr), "no hands in the input");
  EXPECT_EQ(WhyNoHands(BuiltinBody(), &made.seen), "the body has no finger joints");
  EXPECT_TRUE(ShowsHand(made.seen));
  HandsAndFaceSequence none = made.seen;
  for (auto& frame : none.frames) frame = nullptr;
  EXPECT_EQ(WhyNoHands(body, &none), "no hand is seen");
  EXPECT_FALSE(ShowsHand(none));
  EXPECT_EQ(WhyNoHands(BuiltinBody(), &none), "no hand is seen") << "which the body's joints do not matter for";
  const Track before = made.track;
  const auto summaries = FitHands(body, none, {}, {}, 1, &made.track);
  EXPECT_FALSE(summaries[0].ran);
  EXPECT_EQ(summaries[1].why, "no hand is seen");
  EXPECT_EQ(made.track.motion.poses, before.motion.poses);
  none.frames.pop_back();
  EXPECT_THROW(FitHands(body, none, {}, {}, 1, &made.track), std::invalid_argument);
}

TEST(FitHands, AHandAtTheOthersPlaceIsNotUsed) {
  SyntheticHands made = MakeSyntheticHands({.pose = "fist", .frames = 20}), exchanged = made;
  for (size_t t = 5; t < 8; ++t) {
    auto frame = std::make_shared<HandsAndFace>(*made.seen.frames[t]);
    std::swap(frame->hands[0], frame->hands[1]);
    exchanged.seen.frames[t] = frame;
    made.seen.frames[t] = nullptr;
  }
  FitHands(BuiltinBodyWithHands(), made.seen, {}, {}, 2, &made.track);
  const auto summaries = FitHands(BuiltinBodyWithHands(), exchanged.seen, {}, {}, 2, &exchanged.track);
  EXPECT_EQ(summaries[0].frames_seen, 17);
  EXPECT_EQ(exchanged.track.motion.poses, made.track.motion.poses) << "as where they are not seen";
}

TEST(FitHands, TinyHandsAreLeftAtRest) {
  SyntheticHands made = MakeSyntheticHands({.pose = "fist", .size_px = 12, .frames = 6});
  const auto summaries = FitHands(BuiltinBodyWithHands(), made.seen, {}, {}, 1, &made.track);
  EXPECT_EQ(summaries[0].frames_seen, 0);
  EXPECT_EQ(summaries[0].why, "not seen, or too small; rests");
  const HandAngleVector angles = AnglesAt(made.track, HandOfSide(0), 3);
  for (const int angle : FreeHandAngles()) EXPECT_NEAR(angles[angle], BuiltinHandPrior().mean[angle], 3 * kDegree);
}

/// The same solve with hands and without them, of a clip and of people in a scene.
TEST(FitHands, TheBodyIsAsWithoutHands) {
  const SyntheticHands made = MakeSyntheticHands({.pose = "fist", .frames = 12});
  KeypointSequence joints;
  joints.convention = "coco17";
  joints.names = {CocoNames().begin(), CocoNames().end()};
  joints.timestamps = made.seen.timestamps;
  joints.image_width = joints.image_height = 4000;
  for (const MatrixX3d& places : made.track.coco17) {
    for (Eigen::Index k = 0; k < places.rows(); ++k) {
      Eigen::Vector2d pixel;
      made.track.camera.Project(places.row(k), &pixel);
      joints.points.push_back({float(pixel.x()), float(pixel.y()), 0.9F});
    }
  }
  TrackSequenceInput without;
  without.body = &BuiltinBodyWithHands();
  without.keypoints = &joints;
  without.camera = made.track.camera;
  TrackSequenceInput with = without;
  with.hands_and_face = &made.seen;
  const TrackSequenceOptions options;
  const std::vector<PlanEntry> plan = PlanHandsAndHead(with);
  ASSERT_EQ(plan.size(), 2U);
  EXPECT_TRUE(plan[0].what == "hands" && plan[0].runs);
  EXPECT_TRUE(plan[1].what == "head by the face" && !plan[1].runs) << "no face is seen";
  std::vector<PlanEntry> skipped = plan;
  SkipHandsAndHead("switched off", &skipped);
  EXPECT_TRUE(!skipped[0].runs && skipped[0].why == "switched off" && !skipped[1].runs);
  const TrackSequenceResult plain = FitClip(without, options), fitted = FitClip(with, options);
  const TrackPeopleResult people = TrackPeople({with}, options);
  ASSERT_TRUE(plain.summary.IsUsable());
  EXPECT_TRUE(plain.summary.hands.empty());
  ASSERT_EQ(fitted.summary.hands.size(), 2U);
  EXPECT_TRUE(fitted.summary.hands[0].ran && fitted.summary.hands[1].ran);
  EXPECT_EQ(people.people[0].track.motion.poses, fitted.track.motion.poses);
  const auto line = [](const TrackSequenceResult& result) {
    const auto& lines = result.summary.plan;
    return std::count_if(lines.begin(), lines.end(),
                         [](const auto& entry) { return entry.what == "hands" && entry.runs; });
  };
  EXPECT_EQ(line(fitted), 1);
  EXPECT_EQ(line(people.people[0]), 1) << "though they come after all fits";
  EXPECT_EQ(fitted.track.motion.trans, plain.track.motion.trans);
  std::set<int> free;
  for (size_t side = 0; side < 2; ++side) {
    const HandSkeleton hand = HandOfSide(side);
    free.insert(hand.joint.begin(), hand.joint.end());
    free.insert({hand.wrist, BuiltinBodyWithHands().parents()[hand.wrist]});
  }
  for (int j = 0; j < BuiltinBodyWithHands().num_joints(); ++j) {
    const bool same = fitted.track.motion.poses.middleCols<3>(3 * j) == plain.track.motion.poses.middleCols<3>(3 * j);
    EXPECT_EQ(same, free.count(j) == 0) << j;
  }
}

}  // namespace
}  // namespace bodyloom::fit_hands_test
