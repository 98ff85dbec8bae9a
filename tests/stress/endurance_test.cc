// SPDX-License-Identifier: Apache-2.0
// Many solves in one process, and long clips.
#include <cmath>
#include <ctime>

#include "data_tools/body/builtin_body.h"
#include "tests/stress/stress_support.h"
#include "tests/support/toy_body.h"

namespace bodyloom::stress::endurance_test {
namespace {

class Endurance : public EngineTest {};
BODYLOOM_WITH_EVERY_ENGINE(Endurance);

TEST_P(Endurance, MemoryDoesNotGrowOver1000Solves) {
  const SynthClip clip = DemoClip(ToyBody(), 1, 15, 10);
  TrackSequenceInput input = InputOf(ToyBody(), clip);
  TrackSequenceOptions options = OptionsOf(GetParam());
  options.max_iterations = 2;
  options.rendered_uv.weight = 0;
  options.num_threads = 2;
  const auto solve = [&](int times) {
    for (int i = 0; i < times; ++i) ASSERT_TRUE(FitClip(input, options).summary.IsUsable());
  };
  solve(200);  // pools and caches are filled
  const size_t before = BytesHeld();
  solve(1000);
  const size_t after = BytesHeld();
  // A leak of one frame's pose a solve (0.6 kB) would show.
  EXPECT_LT(static_cast<double>(after), static_cast<double>(before) + 0.5e6) << before << " -> " << after;
}

/// Processor seconds of one fit of a clip of `frames` at 15 frames a second (all of them in every stage).
double Seconds(const KeypointSequence& keypoints, const SynthClip& clip, const std::string& engine,
               TrackSequenceResult* result) {
  TrackSequenceInput input = InputOf(BuiltinBody(), clip);
  input.keypoints = &keypoints;
  TrackSequenceOptions options = OptionsOf(engine);
  options.estimate_uncertainty = true;
  const std::clock_t start = std::clock();
  *result = Fit(input, options);
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// The first `frames` of a sequence.
KeypointSequence Head(const KeypointSequence& keypoints, int frames) {
  KeypointSequence head = keypoints;
  head.timestamps.resize(frames);
  head.points.resize(static_cast<size_t>(frames) * keypoints.names.size());
  return head;
}

TEST_P(Endurance, SlowTimeGrowsLinearly) {
  const SynthClip clip = DemoClip(BuiltinBody(), 2000);
  TrackSequenceResult result;
  Seconds(Head(clip.keypoints, 100), clip, GetParam(), &result);
  const double short_s = Seconds(Head(clip.keypoints, 400), clip, GetParam(), &result);
  const double per_iteration_short = short_s / 400 / result.summary.iterations;
  const double long_s = Seconds(clip.keypoints, clip, GetParam(), &result);
  const double per_iteration_long = long_s / 2000 / result.summary.iterations;
  std::cout << "ms a frame: 400 frames " << 1e3 * short_s / 400 << ", 2000 frames " << 1e3 * long_s / 2000
            << "; ms a frame and iteration " << 1e3 * per_iteration_short << ", " << 1e3 * per_iteration_long << "\n";
  // Five times the frames in at most 1.3 times five times the time an iteration; quadratic would be 5.
  EXPECT_LT(per_iteration_long, 1.3 * per_iteration_short);
  EXPECT_LT(ErrorMm(result, clip), 90);
}

TEST_P(Endurance, SlowClipOf20000Frames) {
  SynthClipOptions options;
  options.camera.width = 240;  // the truth's visibility is rendered for each frame
  options.camera.height = 180;
  const SynthClip clip = DemoClip(BuiltinBody(), 20000, 60, 0, options);
  TrackSequenceInput input = InputOf(BuiltinBody(), clip);
  TrackSequenceOptions engine = OptionsOf(GetParam());
  engine.num_threads = 2;
  engine.estimate_uncertainty = true;
  const size_t before = BytesHeld();
  const std::clock_t start = std::clock();
  const TrackSequenceResult result = Fit(input, engine);
  ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
  std::cout << "20,000 frames: " << static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC << " s, "
            << static_cast<double>(BytesHeld() - before) / 1e6 << " MB kept, error " << ErrorMm(result, clip)
            << " mm\n";
  EXPECT_EQ(result.summary.frames_by_status.at("tracked"), 20000);
  EXPECT_LT(ErrorMm(result, clip), 90);
}

}  // namespace
}  // namespace bodyloom::stress::endurance_test
