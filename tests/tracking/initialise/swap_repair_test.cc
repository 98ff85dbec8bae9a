// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/swap_repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <utility>

#include "data_tools/body/builtin_body.h"
#include "data_tools/observations/load_detections.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "tests/support/paths.h"
#include "tracking/initialise/outlier_frames.h"

namespace bodyloom::swap_repair_test {
namespace {

/// A person 400 px tall who walks to the right; ankles and wrists swing through each other at 1 Hz.
KeypointSequence Walk(int frames, double fps) {
  KeypointSequence k;
  k.names = CocoNames();
  std::mt19937_64 random(5);
  std::normal_distribution<float> noise(0, 3);
  for (int t = 0; t < frames; ++t) {
    const double time = t / fps;
    k.timestamps.push_back(time);
    for (int i = 0; i < 17; ++i) {
      const bool left = k.names[i].rfind("left_", 0) == 0;
      const double down = i < 5 ? 0 : i < 7 ? 80 : i < 9 ? 150 : i < 11 ? 210 : i < 13 ? 200 : i < 15 ? 300 : 400;
      const double swing = i < 7 || (i >= 11 && i < 13) ? 12 : 60;
      const double phase = (left ? 1 : -1) * (i >= 11 ? 1 : -1) * swing * std::sin(2 * M_PI * time);
      k.points.push_back({static_cast<float>(500 + 100 * time + phase) + noise(random),
                          static_cast<float>(300 + down) + noise(random), 0.9F});
    }
  }
  return k;
}

double Difference(const KeypointSequence& a, const KeypointSequence& b) {
  double sum = 0;
  for (size_t i = 0; i < a.points.size(); ++i)
    sum += std::hypot(a.points[i].x - b.points[i].x, a.points[i].y - b.points[i].y);
  return sum;
}

TEST(SwapRepair, LeavesCrossingLimbsAlone) {
  for (double fps : {25.0, 60.0}) {
    KeypointSequence k = Walk(200, fps);
    const KeypointSequence before = k;
    EXPECT_EQ(RepairSwaps(&k), 0) << fps;
    EXPECT_EQ(Difference(k, before), 0);
  }
}

TEST(SwapRepair, RepairsShortSwapsOfPairsThatAreApart) {
  KeypointSequence k = Walk(120, 30);
  const KeypointSequence truth = k;
  int swapped = 0;
  for (int start : {6, 50, 97}) {  // ankles are about 60 px apart at a quarter period (7.5 frames)
    for (int t = start; t < start + 3; ++t) {
      std::swap(k.at(t, 15), k.at(t, 16));
      ++swapped;
    }
  }
  ASSERT_GT(Difference(k, truth), 100);
  const int repaired = RepairSwaps(&k);
  EXPECT_GE(repaired, swapped - 1);
  EXPECT_LE(repaired, swapped);
  EXPECT_LT(Difference(k, truth), 250);  // at most one frame, where the ankles are close, is left
}

TEST(SwapRepair, MissingPointsAreNotTouched) {
  KeypointSequence k = Walk(60, 30);
  for (int t = 10; t < 20; ++t) k.at(t, 15).confidence = 0;
  const KeypointSequence before = k;
  EXPECT_EQ(RepairSwaps(&k), 0);
  EXPECT_EQ(Difference(k, before), 0);
  KeypointSequence empty;
  EXPECT_EQ(RepairSwaps(&empty), 0);
}

/// The demo motion, 30 frames a second, as a detector sees it who never errs about sides.
KeypointSequence Demo(int frames) {
  SynthClipOptions options;
  options.dense_per_frame = 0;
  options.detection.swap_probability = 0;
  return MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), frames, 30), options).keypoints;
}

void ExchangeSides(int begin, int end, KeypointSequence* k) {
  for (size_t left = 0; left < k->names.size(); ++left) {
    if (!k->names[left].starts_with("left_")) continue;
    const auto right = std::find(k->names.begin(), k->names.end(), "right_" + k->names[left].substr(5));
    for (int t = begin; t < end; ++t) std::swap(k->at(t, int(left)), k->at(t, int(right - k->names.begin())));
  }
}

/// Frames in which the shoulders lie elsewhere.
int FramesThatDiffer(const KeypointSequence& a, const KeypointSequence& b) {
  const auto shoulder = int(std::find(a.names.begin(), a.names.end(), "left_shoulder") - a.names.begin());
  int count = 0;
  for (int t = 0; t < a.num_frames(); ++t) count += a.at(t, shoulder).x != b.at(t, shoulder).x ? 1 : 0;
  return count;
}

TEST(SwapRepair, WholeBodiesAreExchangedBackAfterASecond) {
  const KeypointSequence truth = Demo(150);
  for (const int begin : {70, 95, 110}) {  // the shoulders are seen from the front in frames 60 to 150
    KeypointSequence k = truth;
    ExchangeSides(begin, begin + 30, &k);
    ASSERT_EQ(FramesThatDiffer(k, truth), 30);
    EXPECT_GT(RepairSwaps(&k), 30 * 5) << begin;
    EXPECT_LE(FramesThatDiffer(k, truth), 1) << begin;
  }
}

TEST(SwapRepair, NothingSaysWhichSideOfOneExchangeIsRight) {
  const KeypointSequence truth = Demo(90);
  KeypointSequence k = truth;
  ExchangeSides(60, 90, &k);
  RepairSwaps(&k);
  EXPECT_EQ(FramesThatDiffer(k, truth), 30);
}

/// A person of shoulders 100 px wide who stands and turns at `speed` radians a second.
KeypointSequence Turning(int frames, double fps, double speed) {
  KeypointSequence k;
  k.names = CocoNames();
  std::mt19937_64 random(3);
  std::normal_distribution<float> noise(0, 5);
  for (int t = 0; t < frames; ++t) {
    k.timestamps.push_back(t / fps);
    for (int i = 0; i < 17; ++i) {
      const double side = i == 0 ? 0 : k.names[size_t(i)].starts_with("left_") ? 1 : -1;
      const double wide = i < 5 ? 10 : i < 7 ? 50 : i < 11 ? 70 : i < 13 ? 30 : 35;
      const double down = i < 5 ? 0 : i < 7 ? 80 : i < 9 ? 150 : i < 11 ? 210 : i < 13 ? 210 : i < 15 ? 300 : 400;
      const float u = noise(random), v = noise(random);
      k.points.push_back(
          {float(500 + side * wide * std::cos(speed * t / fps)) + u, static_cast<float>(300 + down) + v, 0.9F});
    }
  }
  return k;
}

TEST(SwapRepair, TurnsUpToTwoASecondAreLeftAlone) {
  for (const double fps : {25.0, 30.0, 60.0}) {
    for (const double turns : {0.3, 1.0, 1.5, 2.0}) {
      KeypointSequence k = Turning(200, fps, 2 * M_PI * turns);
      const KeypointSequence before = k;
      RepairSwaps(&k);
      EXPECT_EQ(FramesThatDiffer(k, before), 0) << fps << " frames a second, " << turns << " turns";
    }
  }
}

/// Numbers of frames of an AIST++ clip, in all nine cameras, whose shoulders are exchanged, or that are left out.
TEST(SwapRepair, RealDancersInNineCamerasStayAsTheyAre) {
  const std::string folder = SharedDir() + "/data/aistpp/keypoints2d/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  for (const std::string clip : {"gBR_sBM_cAll_d06_mBR2_ch06", "gJS_sBM_cAll_d03_mJS2_ch07"}) {
    int exchanged = 0, dropped = 0;
    for (int view = 1; view <= 9; ++view) {
      LoadDetectionsOptions options;
      options.view = "c0" + std::to_string(view);
      options.image_width = 1920, options.image_height = 1080;
      KeypointSequence k = LoadDetections(folder + clip + ".pkl", options);
      dropped += RemoveOutlierFrames(&k);
      const KeypointSequence before = k;
      RepairSwaps(&k);
      exchanged += FramesThatDiffer(k, before);
    }
    EXPECT_EQ(dropped, 0) << clip;
    // Of 5184. In frames 67 to 73 of c06 the detector exchanges the break dancer's sides to and fro.
    EXPECT_LE(exchanged, clip.starts_with("gBR") ? 4 : 0) << clip;
  }
}

TEST(Cuts, JumpsAndGapsAreFoundFastMotionIsNot) {
  KeypointSequence k = Walk(100, 30);
  for (size_t i = 40 * 17; i < k.points.size(); ++i) k.points[i].x += 450;  // another shot from frame 40 on
  for (int t = 70; t < 100; ++t) k.timestamps[t] += 5;
  const std::vector<char> cuts = FindCuts(k);
  for (int t = 0; t < 100; ++t) EXPECT_EQ(cuts[t], t == 40 || t == 70) << t;
}

TEST(Viterbi, FindsTheCheapestOfAllPaths) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit;
  std::vector<std::vector<double>> unary(5);
  const int sizes[5] = {2, 3, 1, 4, 3};
  for (int t = 0; t < 5; ++t) {
    for (int s = 0; s < sizes[t]; ++s) unary[t].push_back(unit(random));
  }
  std::vector<double> table(5 * 16);
  for (double& x : table) x = unit(random);
  const auto transition = [&](size_t t, int a, int b) { return table[16 * t + 4 * a + b]; };
  const auto cost = [&](const std::vector<int>& path) {
    double sum = unary[0][path[0]];
    for (size_t t = 1; t < path.size(); ++t) sum += unary[t][path[t]] + transition(t, path[t - 1], path[t]);
    return sum;
  };
  double best = 1e30;
  for (int code = 0; code < 2 * 3 * 1 * 4 * 3; ++code) {
    std::vector<int> path;
    for (int t = 0, rest = code; t < 5; ++t) {
      path.push_back(rest % sizes[t]);
      rest /= sizes[t];
    }
    best = std::min(best, cost(path));
  }
  EXPECT_DOUBLE_EQ(cost(Viterbi(unary, transition)), best);
  EXPECT_TRUE(Viterbi({}, transition).empty());
}

}  // namespace
}  // namespace bodyloom::swap_repair_test
