// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/outlier_frames.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/motion/load_motion.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "tests/support/paths.h"
#include "tracking/initialise/body_rods.h"
#include "tracking/initialise/swap_repair.h"

namespace bodyloom::outlier_frames_test {
namespace {

constexpr double kFps = 30;

KeypointSequence Detected(const Motion& motion, double yaw_deg = 0) {
  SynthClipOptions options;
  options.dense_per_frame = 0;
  options.camera.yaw_deg = yaw_deg;
  return MakeSynthClip(BuiltinBody(), motion, options).keypoints;
}

/// Mirrors the seen landmarks of a frame from top to bottom, in their own box.
void TurnUpsideDown(int t, KeypointSequence* k) {
  float low = 1e9F, high = -1e9F;
  for (int i = 0; i < k->num_points(); ++i) {
    if (!IsSeen(k->at(t, i))) continue;
    low = std::min(low, k->at(t, i).y), high = std::max(high, k->at(t, i).y);
  }
  for (int i = 0; i < k->num_points(); ++i) k->at(t, i).y = low + high - k->at(t, i).y;
}

std::vector<int> EmptiedFrames(const KeypointSequence& before, const KeypointSequence& after) {
  std::vector<int> frames;
  for (int t = 0; t < before.num_frames(); ++t) {
    if (SeenBodySize(before, t) > 0 && SeenBodySize(after, t) == 0) frames.push_back(t);
  }
  return frames;
}

TEST(OutlierFrames, APersonUpsideDownForASecondIsDropped) {
  for (const int length : {1, 15, 36}) {
    KeypointSequence k = Detected(DemoMotion(BuiltinBody(), 120, kFps));
    std::vector<int> expected;
    for (int t = 40; t < 40 + length; ++t) {
      TurnUpsideDown(t, &k);
      expected.push_back(t);
    }
    const KeypointSequence before = k;
    EXPECT_EQ(RemoveOutlierFrames(&k), length);
    EXPECT_EQ(EmptiedFrames(before, k), expected);
  }
}

TEST(OutlierFrames, WhoGetsUpsideDownInStepsIsKept) {
  // A wheel of one turn in 0.6 s, as in a somersault: every landmark about the middle of the hips.
  KeypointSequence k = Detected(DemoMotion(BuiltinBody(), 90, kFps));
  const auto index = [&](const std::string& name) {
    return int(std::find(k.names.begin(), k.names.end(), name) - k.names.begin());
  };
  const int l_hip = index("left_hip"), r_hip = index("right_hip");
  for (int t = 30; t < 48; ++t) {
    const double angle = 2 * M_PI * (t - 30) / 18.0;
    const double x = 0.5 * (k.at(t, l_hip).x + k.at(t, r_hip).x), y = 0.5 * (k.at(t, l_hip).y + k.at(t, r_hip).y);
    for (int i = 0; i < k.num_points(); ++i) {
      Keypoint& p = k.at(t, i);
      const double dx = p.x - x, dy = p.y - y;
      p.x = float(x + std::cos(angle) * dx - std::sin(angle) * dy);
      p.y = float(y + std::sin(angle) * dx + std::cos(angle) * dy);
    }
  }
  EXPECT_EQ(RemoveOutlierFrames(&k), 0);
}

TEST(OutlierFrames, UpsideDownUpToTheEndIsKept) {
  KeypointSequence k = Detected(DemoMotion(BuiltinBody(), 90, kFps));
  for (int t = 60; t < 90; ++t) TurnUpsideDown(t, &k);
  EXPECT_EQ(RemoveOutlierFrames(&k), 0);
}

TEST(OutlierFrames, RecordedCartwheelsAndFlipsAreKept) {
  const std::string folder = SharedDir() + "/data/motion/deepmimic/humanoid3d_";
  if (!std::filesystem::exists(folder + "cartwheel.txt")) GTEST_SKIP() << folder << "cartwheel.txt is not there";
  for (const std::string motion : {"cartwheel", "backflip", "sideflip", "roll"}) {
    LoadMotionOptions options;
    options.resample_fps = kFps;
    const Motion recorded = LoadMotion(folder + motion + ".txt", options);
    for (const double yaw_deg : {0.0, 60.0, 130.0}) {
      KeypointSequence k = Detected(recorded, yaw_deg);
      EXPECT_EQ(RemoveOutlierFrames(&k), 0) << motion << " from " << yaw_deg << " degrees";
    }
  }
}

TEST(BodyRods, TheSmallestTurnBetweenTwoProjections) {
  EXPECT_NEAR(SmallestTurn({1, 0}, {0, 1}), M_PI / 2, 1e-12);
  EXPECT_NEAR(SmallestTurn({0, -1}, {0, 1}), M_PI, 1e-12);
  EXPECT_NEAR(SmallestTurn({0.5, 0}, {0.5, 0}), 0, 1e-7);
  // Half as long on either side: 60 degrees out of the image before and after.
  EXPECT_NEAR(SmallestTurn({0.5, 0}, {-0.5, 0}), M_PI / 3, 1e-12);
  EXPECT_NEAR(SmallestTurn({3, 0}, {0, 2}), M_PI / 2, 1e-12) << "longer than a rod counts as one seen from the side";
  EXPECT_TRUE(std::isnan(SmallestTurn({std::nan(""), 0}, {1, 0})));
}

}  // namespace
}  // namespace bodyloom::outlier_frames_test
