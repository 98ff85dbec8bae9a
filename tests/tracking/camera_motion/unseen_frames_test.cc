// SPDX-License-Identifier: Apache-2.0
#include "tracking/camera_motion/unseen_frames.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "geometry/math/rotation.h"

namespace bodyloom::unseen_frames_test {
namespace {

using Eigen::Vector3d;

constexpr double kFps = 30;

std::vector<double> Times(int frames) {
  std::vector<double> times;
  for (int t = 0; t < frames; ++t) times.push_back(t / kFps);
  return times;
}

/// A hand's path: three sines along and about each axis.
std::vector<CameraPose> HandHeld(int frames, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform;
  double rate[6][3], phase[6][3];
  for (int axis = 0; axis < 6; ++axis) {
    for (int n = 0; n < 3; ++n) {
      rate[axis][n] = 1 + 3 * uniform(random);
      phase[axis][n] = 2 * M_PI * uniform(random);
    }
  }
  std::vector<CameraPose> path;
  for (int t = 0; t < frames; ++t) {
    double sum[6] = {};
    for (int axis = 0; axis < 6; ++axis) {
      for (int n = 0; n < 3; ++n) sum[axis] += std::sin(rate[axis][n] * t / kFps + phase[axis][n]);
    }
    const Eigen::Matrix3d R = RotationFromAxisAngle(0.02 * Vector3d(sum[0], sum[1], sum[2]));
    path.push_back({R, -R * (0.05 * Vector3d(sum[3], sum[4], sum[5]))});
  }
  return path;
}

/// The path without the frames from `begin` to before `end`.
CameraPath Without(const std::vector<CameraPose>& poses, int begin, int end) {
  CameraPath path;
  for (int t = 0; t < static_cast<int>(poses.size()); ++t) {
    if (t >= begin && t < end) continue;
    path.timestamps.push_back(t / kFps);
    path.poses.push_back(poses[size_t(t)]);
  }
  return path;
}

TEST(UnseenFrames, ErrorsOfHalfASecondAreWithinTheirDeviation) {
  constexpr int kFrames = 150;
  const std::vector<double> times = Times(kFrames);
  double count = 0, in_1 = 0, in_2 = 0, turned = 0, turns = 0;
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    const std::vector<CameraPose> truth = HandHeld(kFrames, seed);
    const int begin = 20 + static_cast<int>(seed % 90), end = begin + 15;
    const CameraPath path = Without(truth, begin, end);
    const std::vector<double> exact(path.poses.size(), 0);
    const PoseSigmas sigmas = SigmasAt(times, path, {exact, exact});
    const std::vector<CameraPose> bridged = SampleCameraPath(path, times).camera_from_scene;
    const CameraPose first = Inverse(truth.front());
    for (int t = begin; t < end; ++t) {
      const CameraPose seen = Compose(truth[size_t(t)], first);
      const Eigen::Array3d off =
          (CentreOf(bridged[size_t(t)]) - CentreOf(seen)).array().abs() / sigmas.place[size_t(t)];
      count += 3;
      in_1 += double((off < 1).count());
      in_2 += double((off < 2).count());
      const double turn =
          RotationAngleBetween(bridged[size_t(t)].camera_from_world_rotation, seen.camera_from_world_rotation);
      turned += turn * turn / (3 * std::pow(sigmas.rad[size_t(t)], 2));
      turns += 1;
    }
    EXPECT_EQ(sigmas.place[size_t(begin) - 1], 0);
    EXPECT_EQ(sigmas.place[size_t(end)], 0);
  }
  EXPECT_NEAR(in_1 / count, 0.68, 0.08);
  EXPECT_NEAR(in_2 / count, 0.95, 0.04);
  EXPECT_NEAR(std::sqrt(turned / turns), 1, 0.15);
}

TEST(UnseenFrames, OfAConstantAccelerationTheDeviationIsThatParabola) {
  // Along (1, 1, 1) every axis has the same error.
  std::vector<CameraPose> poses;
  for (int t = 0; t < 90; ++t) {
    poses.push_back({Eigen::Matrix3d::Identity(), -0.5 * 0.7 * std::pow(t / kFps, 2) * Vector3d::Ones()});
  }
  const CameraPath path = Without(poses, 31, 50);
  const std::vector<double> sigma(path.poses.size(), 0.01);
  const std::vector<double> times = Times(90);
  const PoseSigmas sigmas = SigmasAt(times, path, {sigma, {sigma}});
  for (int t = 0; t < 90; ++t) {
    const double after = (t - 30) / kFps, before = (50 - t) / kFps;
    const double bridged = t > 30 && t < 50 ? 0.7 * after * before / 2 : 0;
    EXPECT_NEAR(sigmas.place[size_t(t)], std::hypot(0.01, bridged), 1e-9) << t;
    EXPECT_NEAR(sigmas.rad[size_t(t)], 0.01, 1e-6) << t;
  }
  // A gap longer than any part that is seen.
  CameraPath parts = Without(poses, 12, 40);
  parts.timestamps.resize(22);
  parts.poses.resize(22);
  const std::vector<double> few(22, 0.01);
  const PoseSigmas longer = SigmasAt(std::vector<double>{25 / kFps}, parts, {few, few});
  EXPECT_NEAR(longer.place[0], std::hypot(0.01, 0.7 * (14 / kFps) * (15 / kFps) / 2), 1e-9);
}

TEST(UnseenFrames, PassedOverFramesAndEndsHaveTheirNeighbours) {
  const CameraPose rest;
  const CameraPath path{{0, 0.2, 0.4}, {rest, rest, rest}};
  const PoseSigmas sigmas = SigmasAt(std::vector<double>{-1, 0, 0.1, 0.2, 9}, path, {{1, 3, 5}, {}});
  EXPECT_EQ(sigmas.rad, (std::vector<double>{1, 1, 2, 3, 5}));
  EXPECT_TRUE(sigmas.place.empty());
  // Two poses tell nothing of the way between: it may be as far as theirs are apart.
  const CameraPath two{{0, 1}, {rest, {Eigen::Matrix3d::Identity(), Vector3d(-3, 0, 0)}}};
  EXPECT_NEAR(SigmasAt(std::vector<double>{0.5}, two, {{0, 0}, {0, 0}}).place[0], 3, 1e-12);
  EXPECT_THROW(SigmasAt(std::vector<double>{0}, path, {{1, 3}, {}}), std::invalid_argument);
  EXPECT_THROW(SigmasAt(std::vector<double>{0}, {}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::unseen_frames_test
