// SPDX-License-Identifier: Apache-2.0
// The tracker end to end on synthetic clips with known truth.
#include "tracking/clip/clip_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"

namespace bodyloom::track_sequence_test {
namespace {

SynthClip Clip(int frames, int dense) {
  SynthClipOptions options;
  options.dense_per_frame = dense;
  return MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), frames, 15), options);
}

TrackSequenceResult TrackClip(const SynthClip& clip, CameraKnowledge knowledge, int threads = 2) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.keypoints = &clip.keypoints;
  if (!clip.dense.frames[0].empty()) input.dense = &clip.dense;
  input.prior = &BuiltinPosePrior();
  input.camera = clip.truth.camera;
  TrackSequenceOptions options;
  options.camera_knowledge = knowledge;
  options.num_threads = threads;
  return FitClip(input, options);
}

double PaMpjpe(const TrackSequenceResult& result, const SynthClip& clip) {
  return 1000 * ProcrustesPositionError(result.track.joints, clip.truth.joints).frames.mean;
}

TEST(TrackSequence, FindsThePoseFrom2dJointsInEveryCamera) {
  const SynthClip clip = Clip(45, 0);
  for (CameraKnowledge knowledge : {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    const TrackSequenceResult result = TrackClip(clip, knowledge);
    ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
    EXPECT_EQ(result.summary.frames_by_status.at("tracked"), 45);
    // Plain least squares from a T-pose ends at 80 to 120 mm.
    EXPECT_LT(PaMpjpe(result, clip), 70) << static_cast<int>(knowledge);
    EXPECT_LT(result.summary.reprojection_median_px, 12);
  }
}

TEST(TrackSequence, DenseKeypointsGiveTheSurface) {
  const SynthClip clip = Clip(30, 200);
  const TrackSequenceResult result = TrackClip(clip, CameraKnowledge::kKnown);
  ASSERT_TRUE(result.summary.IsUsable());
  EXPECT_LT(PaMpjpe(result, clip), 35);
}

TEST(TrackSequence, SameBytesForAnyNumberOfThreads) {
  const SynthClip clip = Clip(20, 0);
  const TrackSequenceResult one = TrackClip(clip, CameraKnowledge::kKnown, 1),
                            four = TrackClip(clip, CameraKnowledge::kKnown, 4);
  ASSERT_TRUE(one.summary.IsUsable()) << one.summary.message;
  ASSERT_EQ(one.track.num_frames(), 20);
  EXPECT_EQ(one.track.motion.poses, four.track.motion.poses);
  EXPECT_EQ(one.track.motion.trans, four.track.motion.trans);
  EXPECT_EQ(one.summary.final_cost, four.summary.final_cost);
}

TEST(TrackSequence, MissingFramesAreCarriedAndSaidToBeUncertain) {
  SynthClip clip = Clip(40, 0);
  for (int t = 15; t < 23; ++t) {
    for (int k = 0; k < clip.keypoints.num_points(); ++k) clip.keypoints.at(t, k).confidence = 0;
  }
  const TrackSequenceResult result = TrackClip(clip, CameraKnowledge::kKnown);
  ASSERT_TRUE(result.summary.IsUsable());
  EXPECT_EQ(result.summary.frames_by_status.at("interpolated"), 8);
  EXPECT_EQ(result.track.frame_status[18], FrameStatus::kInterpolated);
  EXPECT_TRUE(result.track.motion.poses.allFinite());
  const int wrist = BuiltinBody().FindJoint("l_wrist");
  EXPECT_GT(result.track.joint_sigma(19, wrist), 1.5 * result.track.joint_sigma(5, wrist));
}

TEST(TrackSequence, LongHolesAreLostAndShortOnesCarried) {
  SynthClip clip = Clip(80, 0);  // 15 a second
  const auto hide = [&](int begin, int end) {
    for (int t = begin; t < end; ++t) {
      for (int k = 0; k < clip.keypoints.num_points(); ++k) clip.keypoints.at(t, k).confidence = 0;
    }
  };
  hide(5, 26);   // 22/15 s from sight to sight
  hide(40, 63);  // 24/15 s
  hide(76, 80);
  const TrackSequenceResult result = TrackClip(clip, CameraKnowledge::kKnown);
  ASSERT_TRUE(result.summary.IsUsable());
  EXPECT_EQ(result.summary.frames_by_status.at("interpolated"), 21);
  EXPECT_EQ(result.summary.frames_by_status.at("lost"), 27);
  EXPECT_EQ(result.summary.lost_in_holes, 23);
  EXPECT_EQ(result.summary.FramesReport(), "21 interpolated, 27 lost (23 in holes of more than 1.5 s), 32 tracked");
  for (int t = 0; t < 80; ++t) {
    const bool lost = (t >= 40 && t < 63) || t >= 76;
    EXPECT_EQ(result.track.frame_status[t] == FrameStatus::kLost, lost) << t;
    EXPECT_EQ(result.track.HasResult(t), !lost) << t;
    EXPECT_EQ(result.track.joint_sigma.row(t).array().isNaN().all(), lost) << t;
  }
}

TEST(TrackSequence, FramesBeforeTheFirstAndAfterTheLastSightAreLost) {
  SynthClip clip = Clip(40, 0);
  const auto hide = [&](int begin, int end) {
    for (int t = begin; t < end; ++t) {
      for (int k = 0; k < clip.keypoints.num_points(); ++k) clip.keypoints.at(t, k).confidence = 0;
    }
  };
  hide(0, 6);
  hide(20, 23);
  hide(33, 40);
  const TrackSequenceResult result = TrackClip(clip, CameraKnowledge::kKnown);
  ASSERT_TRUE(result.summary.IsUsable());
  EXPECT_EQ(result.summary.frames_by_status.at("lost"), 13);
  EXPECT_EQ(result.summary.frames_by_status.at("interpolated"), 3);
  EXPECT_EQ(result.summary.frames_by_status.at("tracked"), 24);
  for (int t = 0; t < 40; ++t) {
    const bool lost = t < 6 || t >= 33;
    EXPECT_EQ(result.track.frame_status[t] == FrameStatus::kLost, lost) << t;
    EXPECT_EQ(result.track.HasResult(t), !lost) << t;
    EXPECT_EQ(result.track.coco17[t].allFinite(), !lost) << t;
    EXPECT_EQ(result.track.joint_sigma.row(t).array().isNaN().all(), lost) << t;
  }
}

TEST(TrackSequence, OneFrameAndNoPerson) {
  const SynthClip one = Clip(1, 0);
  EXPECT_TRUE(TrackClip(one, CameraKnowledge::kKnown).summary.IsUsable());
  SynthClip empty = Clip(5, 0);
  for (Keypoint& point : empty.keypoints.points) point.confidence = 0;
  const TrackSequenceResult result = TrackClip(empty, CameraKnowledge::kKnown);
  EXPECT_EQ(result.summary.status, SolveStatus::kFailure);
  EXPECT_NE(result.summary.message.find("shoulder"), std::string::npos);
}

TEST(TrackSequence, ContradictionsAreNamed) {
  SynthClip clip = Clip(5, 0);
  clip.keypoints.image_width = 99;
  try {
    (void)TrackClip(clip, CameraKnowledge::kKnown);
    FAIL() << "an image size that contradicts the camera was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("99x"), std::string::npos) << error.what();
  }
  TrackSequenceInput nothing;
  nothing.body = &BuiltinBody();
  EXPECT_THROW((void)FitClip(nothing, TrackSequenceOptions()), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::track_sequence_test
