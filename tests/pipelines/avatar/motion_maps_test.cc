// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/avatar/motion_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bodyloom/geometry/rotation.h"
#include "tests/support/short_track.h"

namespace bodyloom {
namespace {

constexpr int kSide = 64, kTexels = kSide * kSide;

/// A body turned by `heading_deg` about the vertical that glides to its left at half a body length a second, in one pose.
Track Gliding(int fps, double heading_deg = 0) {
  Track track = ShortTrack(fps);
  for (int t = 0; t < track.num_frames(); ++t) {
    const Eigen::Vector3d root(0, heading_deg * M_PI / 180, 0);
    track.motion.poses.row(t).setZero();
    track.motion.poses.row(t).head<3>() = root.transpose();
    const Eigen::Vector3d left = RotationFromAxisAngle(root) * Eigen::Vector3d::UnitX();
    track.motion.trans.row(t) = Eigen::RowVector3d(0, 0, 4) + 0.85 * t / fps * left.transpose();
  }
  return track;
}

/// The mean over texels of a channel's values that are not 0, and how many are not.
std::pair<double, int> Mean(const std::vector<float>& maps, int channel) {
  double sum = 0;
  int count = 0;
  for (int i = 0; i < kTexels; ++i) {
    const float v = maps[size_t(channel) * kTexels + i];
    sum += v;
    count += v != 0;
  }
  return {count > 0 ? sum / count : 0, count};
}

double SidewaysAt(const Track& track, int frame, int velocity, double network_fps) {
  AvatarMotionMaps maps(BuiltinBody(), track, kSide, network_fps, {}, 1);
  std::vector<float> all(size_t(AvatarMotionMaps::kChannels) * kTexels);
  maps.Maps(frame, all);
  return Mean(all, 3 + 3 * velocity).first;
}

TEST(AvatarMotionMaps, VelocitiesReachBackOneSecond) {
  const Track track = Gliding(30);
  for (int velocity = 0; velocity < 12; ++velocity) EXPECT_NEAR(SidewaysAt(track, 40, velocity, 30), 0.5, 2e-3);
  // What lies before the first frame is zero; the stride of frames 10 to 19 ago has six of its ten.
  EXPECT_NEAR(SidewaysAt(track, 15, 9, 30), 0.5, 2e-3);
  EXPECT_NEAR(SidewaysAt(track, 15, 10, 30), 0.3, 2e-3);
  EXPECT_EQ(SidewaysAt(track, 15, 11, 30), 0);
  EXPECT_EQ(SidewaysAt(track, 4, 5, 30), 0);
}

TEST(AvatarMotionMaps, WhichWayThePersonFacesMakesNoDifference) {
  const Track ahead = Gliding(30), turned = Gliding(30, 115);
  AvatarMotionMaps first(BuiltinBody(), ahead, kSide, 30, {}, 1), second(BuiltinBody(), turned, kSide, 30, {}, 1);
  std::vector<float> a(size_t(AvatarMotionMaps::kChannels) * kTexels), b(a.size());
  first.Maps(40, a);
  second.Maps(40, b);
  double worst = 0;
  for (size_t i = 0; i < a.size(); ++i) worst = std::max(worst, double(std::abs(a[i] - b[i])));
  EXPECT_LT(worst, 3e-3);  // half floats
  // The vertical: the camera's −y, which the pelvis has as its own here.
  const int up = AvatarMotionMaps::kChannels - 3;
  EXPECT_NEAR(Mean(a, up + 1).first, -1, 1e-6);
  EXPECT_EQ(Mean(a, up).second, 0);
}

TEST(AvatarMotionMaps, ATrackOfAnotherRateIsLookedBackAtByTheClock) {
  const Track fast = Gliding(60), slow = Gliding(15);
  EXPECT_NEAR(SidewaysAt(fast, 80, 11, 30), 0.5, 2e-3);
  EXPECT_NEAR(SidewaysAt(fast, 18, 9, 30), 0.5, 2e-3);
  EXPECT_EQ(SidewaysAt(fast, 17, 9, 30), 0);
  EXPECT_NEAR(SidewaysAt(slow, 5, 9, 30), 0.5, 2e-3);
  EXPECT_EQ(SidewaysAt(slow, 4, 9, 30), 0);
}

TEST(AvatarMotionMaps, NormalsComeFirstAndAFrameShownAgainMovesAsItDid) {
  const Track track = Gliding(30);
  AvatarMotionMaps maps(BuiltinBody(), track, kSide, 30, {20, 20, 20}, 1),
      straight(BuiltinBody(), track, kSide, 30, {}, 1);
  std::vector<float> shown(size_t(AvatarMotionMaps::kChannels) * kTexels), truth(shown.size());
  straight.Maps(20, truth);
  for (int t = 0; t < 3; ++t) {
    maps.Maps(t, shown);
    EXPECT_EQ(shown, truth);
  }
  int unit = 0;
  for (int i = 0; i < kTexels; ++i) {
    const float x = truth[i], y = truth[kTexels + i], z = truth[2 * kTexels + i];
    const float square = x * x + y * y + z * z;
    EXPECT_TRUE(square == 0 || std::abs(square - 1) < 5e-3) << square;
    unit += square > 0;
  }
  EXPECT_GT(unit, 1000);
}

TEST(AvatarMotionMaps, RatesOfTracks) {
  EXPECT_NEAR(MotionRate(Gliding(60)), 60, 1e-6);
  Track still = Gliding(30);
  still.motion.timestamps.clear();
  EXPECT_EQ(MotionRate(still), 30);
}

}  // namespace
}  // namespace bodyloom
