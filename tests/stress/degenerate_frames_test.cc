// SPDX-License-Identifier: Apache-2.0
// Frames with too few or only false observations.
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "data_tools/body/builtin_body.h"
#include "tests/stress/stress_support.h"

namespace bodyloom::stress::degenerate_frames_test {
namespace {

class DegenerateFrames : public EngineTest {};
BODYLOOM_WITH_EVERY_ENGINE(DegenerateFrames);

constexpr int kFrames = 45;

const SynthClip& Clip() {
  static const SynthClip clip = DemoClip(BuiltinBody(), kFrames);
  return clip;
}

/// The untouched clip's answer, once for each engine.
const TrackSequenceResult& Untouched(const std::string& engine) {
  static std::map<std::string, TrackSequenceResult> results;
  const auto it = results.find(engine);
  if (it != results.end()) return it->second;
  return results[engine] = Fit(InputOf(BuiltinBody(), Clip()), OptionsOf(engine));
}

TrackSequenceResult FitKeypoints(const KeypointSequence& keypoints, const std::string& engine) {
  TrackSequenceInput input = InputOf(BuiltinBody(), Clip());
  input.keypoints = &keypoints;
  return Fit(input, OptionsOf(engine));
}

/// Frames 20 to 24, a third of a second in the middle.
std::vector<int> Bad() { return {20, 21, 22, 23, 24}; }

/// Frames at least half a second away from them.
std::vector<int> FarFromBad() {
  std::vector<int> frames;
  for (int t = 0; t < kFrames; ++t) {
    if (t < 20 - 8 || t > 24 + 8) frames.push_back(t);
  }
  return frames;
}

double MeanErrorMm(const TrackSequenceResult& result, const std::vector<int>& frames) {
  double sum = 0;
  for (const int t : frames) sum += ErrorMm(result, Clip(), t) / static_cast<double>(frames.size());
  return sum;
}

/// Bad frames do not spoil what is half a second away, and themselves are carried by their neighbours.
void ExpectContained(const TrackSequenceResult& result, const std::string& engine, double bad_mm) {
  ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
  EXPECT_LT(MeanErrorMm(result, FarFromBad()), MeanErrorMm(Untouched(engine), FarFromBad()) + 5);
  EXPECT_LT(MeanErrorMm(result, Bad()), bad_mm);
}

TEST_P(DegenerateFrames, NoneOneAndTwoPoints) {
  for (const int points : {0, 1, 2}) {
    KeypointSequence keypoints = Clip().keypoints;
    for (const int t : Bad()) {
      for (int k = points; k < keypoints.num_points(); ++k) keypoints.at(t, k).confidence = 0;
    }
    const TrackSequenceResult result = FitKeypoints(keypoints, GetParam());
    ExpectContained(result, GetParam(), 100);
    for (const int t : Bad()) {
      EXPECT_EQ(result.track.frame_status[t], points == 0 ? FrameStatus::kInterpolated : FrameStatus::kWeak);
    }
  }
}

TEST_P(DegenerateFrames, OutliersOnly) {
  std::mt19937 random(1);
  KeypointSequence keypoints = Clip().keypoints;
  for (const int t : Bad()) {
    for (int k = 0; k < keypoints.num_points(); ++k) {
      keypoints.at(t, k) = {static_cast<float>(random() % 960), static_cast<float>(random() % 720), 0.9F};
    }
  }
  const TrackSequenceResult result = FitKeypoints(keypoints, GetParam());
  ExpectContained(result, GetParam(), 100);
  EXPECT_EQ(result.summary.plan.back().what, "2D joints of impossible frames");
  for (const int t : Bad()) EXPECT_EQ(result.track.frame_status[t], FrameStatus::kInterpolated) << t;
}

TEST_P(DegenerateFrames, AllPointsOnOneLineOrInOnePlace) {
  for (const bool line : {true, false}) {
    KeypointSequence keypoints = Clip().keypoints;
    for (const int t : Bad()) {
      for (int k = 0; k < keypoints.num_points(); ++k) {
        keypoints.at(t, k) = {480, line ? keypoints.at(t, k).y : 360, 0.9F};
      }
    }
    ExpectContained(FitKeypoints(keypoints, GetParam()), GetParam(), 200);
  }
}

TEST_P(DegenerateFrames, AWholeClipOnOneLineOrInOnePlaceEnds) {
  for (const bool line : {true, false}) {
    KeypointSequence keypoints = Clip().keypoints;
    for (Keypoint& point : keypoints.points) point = {480, line ? point.y : 360, 0.9F};
    FitKeypoints(keypoints, GetParam());  // ExpectSound is the promise: no pose can be right
  }
}

TEST_P(DegenerateFrames, EveryLandmarkTwice) {
  KeypointSequence keypoints = Clip().keypoints;
  const int K = keypoints.num_points();
  std::vector<Keypoint> points;
  for (int t = 0; t < kFrames; ++t) {
    for (int k = 0; k < 2 * K; ++k) points.push_back(Clip().keypoints.at(t, k % K));
  }
  keypoints.points = points;
  keypoints.names.insert(keypoints.names.end(), Clip().keypoints.names.begin(), Clip().keypoints.names.end());
  const TrackSequenceResult result = FitKeypoints(keypoints, GetParam());
  ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
  EXPECT_LT(ErrorMm(result, Clip()), ErrorMm(Untouched(GetParam()), Clip()) + 5);
}

TEST_P(DegenerateFrames, OneFrameAndTwo) {
  for (const int frames : {1, 2}) {
    const SynthClip clip = DemoClip(BuiltinBody(), frames);
    for (const CameraKnowledge knowledge :
         {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
      TrackSequenceOptions options = OptionsOf(GetParam());
      options.camera_knowledge = knowledge;
      const TrackSequenceResult result = Fit(InputOf(BuiltinBody(), clip), options);
      ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
      EXPECT_LT(ErrorMm(result, clip), 120);  // no neighbours decide between depth reversals
    }
  }
}

TEST_P(DegenerateFrames, OneOrTwoPointsInAWholeClipAreAFailureThatSaysWhy) {
  for (const int points : {1, 2}) {
    KeypointSequence keypoints = Clip().keypoints;
    for (int t = 0; t < kFrames; ++t) {
      for (int k = points; k < keypoints.num_points(); ++k) keypoints.at(t, k).confidence = 0;
    }
    const TrackSequenceResult result = FitKeypoints(keypoints, GetParam());
    EXPECT_EQ(result.summary.status, SolveStatus::kFailure);
    EXPECT_NE(result.summary.message.find("shoulder"), std::string::npos) << result.summary.message;
  }
}

}  // namespace
}  // namespace bodyloom::stress::degenerate_frames_test
