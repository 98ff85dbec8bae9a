// SPDX-License-Identifier: Apache-2.0
// Clips that end early, lose half of the person, swap left and right, or change the lens.
#include <algorithm>
#include <cmath>

#include "data_tools/body/builtin_body.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "tests/stress/stress_support.h"

namespace bodyloom::stress::broken_clips_test {
namespace {

class BrokenClips : public EngineTest {};
BODYLOOM_WITH_EVERY_ENGINE(BrokenClips);

bool IsLowerBody(const std::string& name) {
  for (const char* part : {"hip", "knee", "ankle", "toe", "heel"}) {
    if (name.find(part) != std::string::npos) return true;
  }
  return false;
}

TrackSequenceResult FitKeypoints(const SynthClip& clip, const KeypointSequence& keypoints, const std::string& engine,
                                 bool uncertainty = false) {
  TrackSequenceInput input = InputOf(BuiltinBody(), clip);
  input.keypoints = &keypoints;
  TrackSequenceOptions options = OptionsOf(engine);
  options.estimate_uncertainty = uncertainty;
  return Fit(input, options);
}

double MeanErrorMm(const TrackSequenceResult& result, const SynthClip& clip, int from, int to) {
  double sum = 0;
  for (int t = from; t < to; ++t) sum += ErrorMm(result, clip, t) / (to - from);
  return sum;
}

TEST_P(BrokenClips, HalfTheBodyUnseenFor200Frames) {
  const SynthClip clip = DemoClip(BuiltinBody(), 300, 30);
  KeypointSequence keypoints = clip.keypoints;
  for (int t = 50; t < 250; ++t) {
    for (int k = 0; k < keypoints.num_points(); ++k) {
      if (IsLowerBody(keypoints.names[k])) keypoints.at(t, k).confidence = 0;
    }
  }
  const TrackSequenceResult result = FitKeypoints(clip, keypoints, GetParam(), true);
  ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
  EXPECT_LT(MeanErrorMm(result, clip, 0, 40), 80);
  EXPECT_LT(MeanErrorMm(result, clip, 260, 300), 80);
  EXPECT_LT(MeanErrorMm(result, clip, 50, 250), 200);
  // The legs stay legs: knees do not fly, and the answer gives them as unknown.
  const int ankle = BuiltinBody().FindJoint("l_ankle"), elbow = BuiltinBody().FindJoint("l_elbow");
  ASSERT_TRUE(ankle >= 0 && elbow >= 0);
  EXPECT_GT(result.track.joint_sigma(150, ankle), 2 * result.track.joint_sigma(20, ankle));
  EXPECT_LT(result.track.joint_sigma(150, elbow), 2 * result.track.joint_sigma(20, elbow));
  double step = 0;
  for (int t = 1; t < 300; ++t) {
    step = std::max(step, (result.track.joints[t] - result.track.joints[t - 1]).rowwise().norm().maxCoeff());
  }
  EXPECT_LT(step, 0.5) << "metres a frame, at 30 frames a second";
}

TEST_P(BrokenClips, LeftAndRightExchangedForATenthOfTheFrames) {
  const SynthClip clip = DemoClip(BuiltinBody(), 60, 15);
  KeypointSequence keypoints = clip.keypoints;
  const auto exchange = [&](int t) {
    for (int k = 0; k < keypoints.num_points(); ++k) {
      if (!keypoints.names[k].starts_with("left_")) continue;
      const auto right =
          std::find(keypoints.names.begin(), keypoints.names.end(), "right_" + keypoints.names[k].substr(5));
      ASSERT_NE(right, keypoints.names.end());
      std::swap(keypoints.at(t, k), keypoints.at(t, static_cast<int>(right - keypoints.names.begin())));
    }
  };
  for (const int t : {12, 13, 30, 31, 45, 46}) exchange(t);
  const TrackSequenceResult result = FitKeypoints(clip, keypoints, GetParam());
  ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
  EXPECT_LT(ErrorMm(result, clip), ErrorMm(FitKeypoints(clip, clip.keypoints, GetParam()), clip) + 15);
  EXPECT_GT(result.summary.num_swaps_repaired, 20);
}

/// Two takes one after the other: the second shows the person elsewhere, in the other direction.
struct CutClip {
  SynthClip first, second;
  KeypointSequence keypoints;
};

CutClip MakeCutClip(int frames) {
  CutClip cut;
  cut.first = DemoClip(BuiltinBody(), frames);
  SynthClipOptions other;
  other.camera.yaw_deg = 150;
  other.camera.fill = 0.5;
  cut.second = DemoClip(BuiltinBody(), frames, 15, 0, other);
  // One camera for both: the second take's camera differs in its place only.
  cut.keypoints = cut.first.keypoints;
  for (int t = 0; t < frames; ++t) {
    cut.keypoints.timestamps.push_back((frames + t) / 15.0);
    for (int k = 0; k < cut.keypoints.num_points(); ++k) {
      Keypoint point = cut.second.keypoints.at(t, k);
      point.x += 250;
      cut.keypoints.points.push_back(point);
    }
  }
  return cut;
}

TEST_P(BrokenClips, ACutInMidClipLeavesBothTakesAlone) {
  const int frames = 30;
  const CutClip cut = MakeCutClip(frames);
  TrackSequenceInput input = InputOf(BuiltinBody(), cut.first);
  input.keypoints = &cut.keypoints;
  const TrackSequenceResult both = Fit(input, OptionsOf(GetParam()));
  ASSERT_TRUE(both.summary.IsUsable()) << both.summary.message;
  const auto error = [&](const SynthClip& take, int at, int from, int to) {
    double sum = 0;
    for (int t = from; t < to; ++t) {
      TrackSequenceResult frame;
      frame.track.joints = {both.track.joints[at + t]};
      SynthClip truth;
      truth.truth.joints = {take.truth.joints[t]};
      sum += ErrorMm(frame, truth, 0) / (to - from);
    }
    return sum;
  };
  const TrackSequenceResult first = FitKeypoints(cut.first, cut.first.keypoints, GetParam());
  KeypointSequence after = cut.keypoints;
  after.points.erase(after.points.begin(), after.points.begin() + frames * after.num_points());
  after.timestamps.erase(after.timestamps.begin(), after.timestamps.begin() + frames);
  const TrackSequenceResult second = FitKeypoints(cut.first, after, GetParam());
  EXPECT_LT(error(cut.first, 0, 0, frames), ErrorMm(first, cut.first) + 15);
  EXPECT_LT(error(cut.first, 0, frames - 4, frames), MeanErrorMm(first, cut.first, frames - 4, frames) + 15);
  EXPECT_LT(error(cut.second, frames, 0, frames), ErrorMm(second, cut.second) + 15);
  EXPECT_LT(error(cut.second, frames, 0, 4), MeanErrorMm(second, cut.second, 0, 4) + 15);
}

TEST_P(BrokenClips, AJumpOfTheFocalLengthMovesThePersonAndKeepsThePose) {
  const SynthClip clip = DemoClip(BuiltinBody(), 60, 15);
  KeypointSequence keypoints = clip.keypoints;
  for (int t = 30; t < 60; ++t) {
    for (int k = 0; k < keypoints.num_points(); ++k) {
      Keypoint& point = keypoints.at(t, k);
      point.x = static_cast<float>(clip.truth.camera.cx + 2 * (point.x - clip.truth.camera.cx));
      point.y = static_cast<float>(clip.truth.camera.cy + 2 * (point.y - clip.truth.camera.cy));
    }
  }
  const TrackSequenceResult result = FitKeypoints(clip, keypoints, GetParam());
  ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
  EXPECT_LT(MeanErrorMm(result, clip, 0, 30), 80);
  EXPECT_LT(MeanErrorMm(result, clip, 30, 60), 100);
  EXPECT_NEAR(result.track.joints[45](0, 2) / clip.truth.joints[45](0, 2), 0.5, 0.1);  // nearer, as in the image
}

TEST_P(BrokenClips, OneTakeInThreeFramesIsSeen) {
  SynthClipOptions options;
  options.dropped_frame_share = 0.65;
  options.dropped_run_frames = 3;
  const SynthClip clip = DemoClip(BuiltinBody(), 60, 15, 0, options);
  const TrackSequenceResult result = FitKeypoints(clip, clip.keypoints, GetParam());
  ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
  EXPECT_LT(ErrorMm(result, clip), 100);
}

TEST_P(BrokenClips, AShapeThatNothingShowsStaysAtItsPrior) {
  const SynthClip clip = DemoClip(BuiltinBody(), 40);
  KeypointSequence keypoints = clip.keypoints;
  for (int t = 0; t < 40; ++t) {
    for (int k = 0; k < keypoints.num_points(); ++k) {
      const std::string& name = keypoints.names[k];
      const bool torso = name.find("shoulder") != std::string::npos || name.find("hip") != std::string::npos;
      if (!torso) keypoints.at(t, k).confidence = 0;
    }
  }
  const TrackSequenceResult result = FitKeypoints(clip, keypoints, GetParam(), true);
  ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
  EXPECT_LT(result.track.motion.betas.cwiseAbs().maxCoeff(), 1.5) << result.track.motion.betas.transpose();
  EXPECT_EQ(result.summary.frames_by_status.at("weak"), 40);
}

}  // namespace
}  // namespace bodyloom::stress::broken_clips_test
