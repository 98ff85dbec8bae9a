// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "data_tools/motion/resample_track.h"

#include "data_tools/motion/motion_tools.h"

namespace bodyloom::resample_track_test {
namespace {

/// One joint that turns about z at 2 rad/s while it moves along x at 3 m/s, seen at these times.
Track TurningAt(const std::vector<double>& times) {
  Track track;
  const auto T = static_cast<Eigen::Index>(times.size());
  track.motion.body = "smpl";
  track.motion.betas = Eigen::Vector2d(1, 2);
  track.motion.poses = RowMatrixXd::Zero(T, 3);
  track.motion.trans = MatrixX3d::Zero(T, 3);
  track.motion.timestamps = times;
  for (Eigen::Index t = 0; t < T; ++t) {
    track.motion.poses(t, 2) = 2 * times[t];
    track.motion.trans(t, 0) = 3 * times[t];
  }
  track.frame_status.assign(T, FrameStatus::kTracked);
  return track;
}

std::vector<double> Regular(int frames, double fps) {
  std::vector<double> times(frames);
  for (int t = 0; t < frames; ++t) times[t] = t / fps;
  return times;
}

void Lose(Track* track, int t) {
  track->motion.trans.row(t).setConstant(std::numeric_limits<double>::quiet_NaN());
  track->frame_status[t] = FrameStatus::kLost;
}

/// Every frame with a result shows the motion at its own time, and times are on the grid.
void ExpectTheMotion(const Track& track, double fps) {
  for (int t = 0; t < track.num_frames(); ++t) {
    const double time = track.motion.timestamps[t];
    EXPECT_NEAR(time * fps, std::round(time * fps), 1e-9) << t;
    if (!track.HasResult(t)) continue;
    EXPECT_NEAR(track.motion.poses(t, 2), 2 * time, 1e-9) << t;
    EXPECT_NEAR(track.motion.trans(t, 0), 3 * time, 1e-9) << t;
  }
}

TEST(ResampleTrack, HalfTheRateIsEverySecondFrame) {
  Track track = TurningAt(Regular(21, 60));
  track.level_m = Eigen::VectorXd::LinSpaced(21, 0, 20);
  const Track half = ResampleTrack(track, 30);
  ASSERT_EQ(half.num_frames(), 11);
  for (int t = 0; t < 11; ++t) {
    EXPECT_EQ(half.motion.poses.row(t), track.motion.poses.row(2 * t)) << t;
    EXPECT_NEAR(half.motion.timestamps[t], t / 30.0, 1e-12);
    EXPECT_EQ(half.LevelAt(t), 2 * t);
  }
  EXPECT_EQ(half.motion.betas, track.motion.betas);
  EXPECT_DOUBLE_EQ(FrameRateWithoutGaps(half.motion), 30);
}

TEST(ResampleTrack, FollowsTheTracksOwnTimes) {
  std::vector<double> times = Regular(25, 50);
  for (size_t t = 1; t < times.size(); ++t) times[t] += 0.007 * std::sin(static_cast<double>(t));
  for (const double fps : {20.0, 30.0, 50.0, 60.0}) {
    const Track track = ResampleTrack(TurningAt(times), fps);
    EXPECT_EQ(track.num_frames(), static_cast<int>(std::floor(times.back() * fps)) + 1);
    ExpectTheMotion(track, fps);
  }
}

TEST(ResampleTrack, WeakPerspectiveCamerasFollow) {
  Track track = TurningAt(Regular(5, 10));
  track.camera.model = CameraModel::kWeakPerspective;
  track.weak_camera = MatrixX3d::Ones(5, 3);
  for (int t = 0; t < 5; ++t) track.weak_camera(t, 1) = t;
  const Track twice = ResampleTrack(track, 20);
  ASSERT_EQ(twice.weak_camera.rows(), 9);
  for (int t = 0; t < 9; ++t) EXPECT_NEAR(twice.weak_camera(t, 1), 0.5 * t, 1e-12);
}

TEST(ResampleTrack, NothingIsInterpolatedAcrossAGap) {
  Track track = TurningAt(Regular(41, 60));
  for (const int t : {11, 20, 21, 22, 23}) Lose(&track, t);
  const Track half = ResampleTrack(track, 30);
  ASSERT_EQ(half.num_frames(), 21);
  ExpectTheMotion(half, 30);
  // One lost frame of sixty a second is no gap of thirty: frame 11 lies between two that are there.
  for (int t = 0; t < 21; ++t) EXPECT_EQ(half.HasResult(t), t != 10 && t != 11) << t;
  EXPECT_EQ(half.frame_status[10], FrameStatus::kLost);
  const Track odd = ResampleTrack(track, 24);
  ExpectTheMotion(odd, 24);
  for (int t = 0; t < odd.num_frames(); ++t) {
    const double time = t / 24.0;
    EXPECT_EQ(odd.HasResult(t), time < 19.001 / 60 || time > 23.999 / 60) << t;
  }
}

TEST(ResampleTrack, AClockThatJumpsLeavesNoFrames) {
  std::vector<double> times = Regular(11, 60);
  for (int t = 0; t < 11; ++t) times.push_back(1e6 + t / 60.0);
  const Track half = ResampleTrack(TurningAt(times), 30);
  EXPECT_EQ(half.num_frames(), 12);
  for (int t = 0; t < 12; ++t) EXPECT_TRUE(half.HasResult(t)) << t;
  EXPECT_NEAR(half.motion.timestamps[6], 1e6, 1e-4);
  EXPECT_NEAR(FrameRateWithoutGaps(half.motion), 30, 1e-3);
}

TEST(ResampleTrack, RefusesWhatHasNoRate) {
  EXPECT_EQ(ResampleTrack(TurningAt({3}), 30).num_frames(), 1);
  EXPECT_THROW(ResampleTrack(TurningAt({}), 30), std::invalid_argument);
  EXPECT_THROW(ResampleTrack(TurningAt({0, 0.1, 0.1}), 30), std::invalid_argument);
  EXPECT_THROW(ResampleTrack(TurningAt({0, 0.1}), 0), std::invalid_argument);
}

TEST(FrameRateWithoutGaps, PausesDoNotCount) {
  std::vector<double> times = Regular(11, 25);
  for (int t = 0; t < 11; ++t) times.push_back(5 + t / 25.0);
  EXPECT_NEAR(FrameRateWithoutGaps(TurningAt(times).motion), 25, 1e-9);
  // Milliseconds, as files often round them to: 33, 33, 34.
  times = Regular(31, 30);
  for (double& time : times) time = std::round(1000 * time) / 1000;
  EXPECT_NEAR(FrameRateWithoutGaps(TurningAt(times).motion), 30, 1e-9);
  EXPECT_EQ(FrameRateWithoutGaps(TurningAt({1}).motion), 0);
}

/// One joint that turns about z by 0.1 rad a frame while it moves along x by 0.2 m a frame; 25 frames a second.
Track Turning(int frames) {
  Track track;
  track.motion.body = "smpl";
  track.motion.poses = RowMatrixXd::Zero(frames, 3);
  track.motion.trans = MatrixX3d::Zero(frames, 3);
  for (int t = 0; t < frames; ++t) {
    track.motion.poses(t, 2) = 0.1 * t;
    track.motion.trans(t, 0) = 0.2 * t;
    track.motion.timestamps.push_back(3 + 0.04 * t);
    track.frame_status.push_back(t < frames / 2 ? FrameStatus::kTracked : FrameStatus::kWeak);
  }
  return track;
}

TEST(PlayTrack, TheSamePosesLaterOrSooner) {
  const Track track = Turning(11);
  for (const double speed : {0.5, 1.0, 2.0, 0.3}) {
    const Track played = PlayedAtSpeed(track, speed);
    ASSERT_EQ(played.num_frames(), static_cast<int>(std::floor(10 / speed + 1e-6)) + 1) << speed;
    for (int t = 0; t < played.num_frames(); ++t) {
      EXPECT_NEAR(played.motion.poses(t, 2), 0.1 * speed * t, 1e-9) << speed;
      EXPECT_NEAR(played.motion.trans(t, 0), 0.2 * speed * t, 1e-9) << speed;
      EXPECT_NEAR(played.motion.timestamps[t], 3 + 0.04 * t, 1e-9) << speed;
    }
    EXPECT_EQ(played.frame_status.front(), FrameStatus::kTracked);
    EXPECT_EQ(played.frame_status.back(), FrameStatus::kWeak);
  }
}

TEST(PlayTrack, WeakPerspectiveCamerasFollow) {
  Track track = Turning(6);
  track.camera.model = CameraModel::kWeakPerspective;
  track.weak_camera = MatrixX3d::Ones(6, 3);
  for (int t = 0; t < 6; ++t) track.weak_camera(t, 1) = t;
  const Track played = PlayedAtSpeed(track, 0.5);
  ASSERT_EQ(played.weak_camera.rows(), 11);
  for (int t = 0; t < 11; ++t) EXPECT_NEAR(played.weak_camera(t, 1), 0.5 * t, 1e-12);
}

TEST(PlayTrack, RefusesGapsAndWildSpeeds) {
  Track track = Turning(6);
  EXPECT_THROW(PlayedAtSpeed(track, 0), std::invalid_argument);
  EXPECT_THROW(PlayedAtSpeed(track, std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
  EXPECT_THROW(PlayedAtSpeed(Turning(1), 0.5), std::invalid_argument);
  track.motion.timestamps[3] += 0.02;
  EXPECT_THROW(PlayedAtSpeed(track, 0.5), std::invalid_argument);
  track = Turning(6);
  track.motion.trans(2, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(PlayedAtSpeed(track, 0.5), std::invalid_argument);
}

}  // namespace

}  // namespace bodyloom::resample_track_test
