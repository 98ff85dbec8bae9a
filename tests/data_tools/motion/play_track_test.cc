// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/resample_track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace bodyloom::play_track_test {
namespace {

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
}  // namespace bodyloom::play_track_test
