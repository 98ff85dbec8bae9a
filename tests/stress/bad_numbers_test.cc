// SPDX-License-Identifier: Apache-2.0
// Invalid numbers of detectors, cameras and clocks.
#include <cmath>
#include <functional>
#include <limits>

#include "data_tools/body/builtin_body.h"
#include "tests/stress/stress_support.h"

namespace bodyloom::stress::bad_numbers_test {
namespace {

class BadNumbers : public EngineTest {};
BODYLOOM_WITH_EVERY_ENGINE(BadNumbers);

constexpr int kFrames = 15;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
constexpr float kTiny = std::numeric_limits<float>::denorm_min();

const SynthClip& Clip() {
  static const SynthClip clip = DemoClip(BuiltinBody(), kFrames, 15, 30);
  return clip;
}

TEST_P(BadNumbers, DetectionsThatAreNoNumbersAreMissing) {
  TrackSequenceInput input = InputOf(BuiltinBody(), Clip());
  input.dense = nullptr;
  KeypointSequence missing = Clip().keypoints, bad = Clip().keypoints;
  const float values[] = {kNaN, kInf, -kInf};
  for (int t = 0; t < kFrames; ++t) {
    const int k = 5 + t % 12;
    missing.at(t, k).confidence = 0;
    (t % 2 == 0 ? bad.at(t, k).x : bad.at(t, k).y) = values[t % 3];
    bad.at(t, k).confidence = 0.95F;
  }
  bad.at(3, 0).confidence = missing.at(3, 0).confidence = kNaN;
  for (const CameraKnowledge knowledge : {CameraKnowledge::kKnown, CameraKnowledge::kWeak}) {
    TrackSequenceOptions options = OptionsOf(GetParam());
    options.camera_knowledge = knowledge;
    input.keypoints = &missing;
    const TrackSequenceResult expected = Fit(input, options);
    input.keypoints = &bad;
    const TrackSequenceResult result = Fit(input, options);
    ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
    EXPECT_TRUE(result.track.motion.poses == expected.track.motion.poses) << static_cast<int>(knowledge);
  }
}

TEST_P(BadNumbers, HugeAndDenormalDetectionsAreOutliers) {
  TrackSequenceInput input = InputOf(BuiltinBody(), Clip());
  input.dense = nullptr;
  const TrackSequenceResult expected = Fit(input, OptionsOf(GetParam()));
  struct Fault {
    float value;
    double mm;  ///< a landmark in the corner of the image is a number that can be believed; the others are left out
  };
  for (const Fault& fault : {Fault{1e6F, 20}, Fault{1e30F, 20}, Fault{-1e30F, 20}, Fault{kTiny, 45}}) {
    KeypointSequence bad = Clip().keypoints;
    for (int t = 0; t < kFrames; t += 3) bad.at(t, 5 + t % 12) = {fault.value, -fault.value, 1};
    input.keypoints = &bad;
    const TrackSequenceResult result = Fit(input, OptionsOf(GetParam()));
    ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
    EXPECT_LT(ErrorMm(result, Clip()), ErrorMm(expected, Clip()) + fault.mm) << fault.value;
  }
}

TEST_P(BadNumbers, ConfidencesOutOfRange) {
  TrackSequenceInput input = InputOf(BuiltinBody(), Clip());
  input.dense = nullptr;
  for (const float confidence : {kTiny, -1.0F, kNaN, 1e30F, kInf}) {
    KeypointSequence bad = Clip().keypoints;
    for (Keypoint& point : bad.points) point.confidence = confidence;
    input.keypoints = &bad;
    const TrackSequenceResult result = Fit(input, OptionsOf(GetParam()));
    EXPECT_EQ(result.summary.IsUsable(), confidence > 1) << confidence << ": " << result.summary.message;
    if (result.summary.IsUsable()) {
      EXPECT_LT(ErrorMm(result, Clip()), 90);
    }
  }
}

TEST_P(BadNumbers, DenseKeypointsThatAreNoNumbersAreMissing) {
  TrackSequenceInput input = InputOf(BuiltinBody(), Clip());
  const TrackSequenceResult expected = Fit(input, OptionsOf(GetParam()));
  ASSERT_TRUE(expected.summary.IsUsable());
  const std::function<void(DenseKeypoint&)> faults[] = {
      [](DenseKeypoint& point) { point.pixel.x() = kNaN; },
      [](DenseKeypoint& point) { point.pixel.y() = kInf; },
      [](DenseKeypoint& point) { point.pixel.setConstant(1e30F); },
      [](DenseKeypoint& point) { point.barycentric.setConstant(kNaN); },
      [](DenseKeypoint& point) { point.sigma_px = kNaN; },
      [](DenseKeypoint& point) { point.sigma_px = 0; },
      [](DenseKeypoint& point) { point.sigma_px = -1; },
      [](DenseKeypoint& point) { point.sigma_px = kTiny; },
      [](DenseKeypoint& point) { point.sigma_px = kInf; },
  };
  int number = 0;
  for (const auto& fault : faults) {
    SCOPED_TRACE(number++);
    DenseSequence bad = Clip().dense;
    for (auto& frame : bad.frames) {
      for (size_t i = 0; i < frame.size(); i += 6) fault(frame[i]);
    }
    input.dense = &bad;
    const TrackSequenceResult result = Fit(input, OptionsOf(GetParam()));
    ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
    EXPECT_LT(ErrorMm(result, Clip()), ErrorMm(expected, Clip()) + 10);
  }
}

/// The call must throw std::invalid_argument whose text has `part`.
template <typename Function>
void ExpectRefused(const Function& call, const std::string& part) {
  try {
    call();
    ADD_FAILURE() << "accepted; expected a refusal that speaks of '" << part << "'";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST_P(BadNumbers, CamerasThatCannotBeAreRefused) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const std::function<void(Camera&)> faults[] = {
      [](Camera& camera) { camera.fx = nan; },
      [](Camera& camera) { camera.fy = inf; },
      [](Camera& camera) { camera.fx = 0; },
      [](Camera& camera) { camera.fx = -800; },
      [](Camera& camera) { camera.cx = nan; },
      [](Camera& camera) { camera.cy = inf; },
      [](Camera& camera) { camera.distortion[2] = nan; },
  };
  int number = 0;
  for (const auto& fault : faults) {
    SCOPED_TRACE(number++);
    TrackSequenceInput input = InputOf(BuiltinBody(), Clip());
    fault(input.camera);
    ExpectRefused([&] { (void)FitClip(input, OptionsOf(GetParam())); }, "camera");
  }
}

TEST_P(BadNumbers, StrangeCamerasEnd) {
  for (const double focal : {1e-3, 1.0, 1e6, 1e30}) {
    TrackSequenceInput input = InputOf(BuiltinBody(), Clip());
    input.camera.fx = input.camera.fy = focal;
    Fit(input, OptionsOf(GetParam()));  // ExpectSound is the promise
  }
}

TEST_P(BadNumbers, ClocksThatCannotBeAreRefused) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const std::function<void(std::vector<double>&)> faults[] = {
      [](std::vector<double>& times) { times[7] = nan; },
      [](std::vector<double>& times) { times.back() = inf; },
      [](std::vector<double>& times) { times[7] = times[6]; },
      [](std::vector<double>& times) { std::swap(times[7], times[6]); },
      [](std::vector<double>& times) { times.pop_back(); },
  };
  int number = 0;
  for (const auto& fault : faults) {
    SCOPED_TRACE(number++);
    KeypointSequence keypoints = Clip().keypoints;
    DenseSequence dense = Clip().dense;
    fault(keypoints.timestamps);
    fault(dense.timestamps);
    TrackSequenceInput input = InputOf(BuiltinBody(), Clip());
    input.keypoints = &keypoints;
    input.dense = nullptr;
    ExpectRefused([&] { (void)FitClip(input, OptionsOf(GetParam())); }, "track: ");
    input.keypoints = nullptr;
    input.dense = &dense;
    ExpectRefused([&] { (void)FitClip(input, OptionsOf(GetParam())); }, "track: ");
  }
}

TEST_P(BadNumbers, ClocksThatAreOnlyStrangeEnd) {
  for (const double seconds : {1e-9, 1e-4, 0.9, 100.0, 1e12}) {
    KeypointSequence keypoints = Clip().keypoints;
    for (int t = 0; t < kFrames; ++t) keypoints.timestamps[t] = t * seconds;
    TrackSequenceInput input = InputOf(BuiltinBody(), Clip());
    input.keypoints = &keypoints;
    input.dense = nullptr;
    const TrackSequenceResult result = Fit(input, OptionsOf(GetParam()));
    EXPECT_TRUE(result.summary.IsUsable()) << seconds << ": " << result.summary.message;
  }
}

TEST_P(BadNumbers, AnInitialiserThatIsNoNumberIsRefused) {
  for (const int what : {0, 1, 2}) {
    Motion start = Clip().truth.motion;
    if (what == 0) start.poses(4, 10) = kNaN;
    if (what == 1) start.trans(4, 2) = kInf;
    if (what == 2) start.betas = Eigen::VectorXd::Constant(10, kNaN);
    TrackSequenceInput input = InputOf(BuiltinBody(), Clip());
    input.initialiser = &start;
    SCOPED_TRACE(what);
    ExpectRefused([&] { (void)FitClip(input, OptionsOf(GetParam())); }, "initialiser");
  }
}

TEST_P(BadNumbers, AnInitialiserFarAwayOrBehindTheCameraEnds) {
  for (const double depth : {0.0, -3.0, 0.01, 500.0}) {
    Motion start = Clip().truth.motion;
    start.trans.col(2).setConstant(depth);
    TrackSequenceInput input = InputOf(BuiltinBody(), Clip());
    input.initialiser = &start;
    Fit(input, OptionsOf(GetParam()));
  }
}

}  // namespace
}  // namespace bodyloom::stress::bad_numbers_test
