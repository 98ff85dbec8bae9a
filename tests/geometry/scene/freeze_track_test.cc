// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/track_edits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "data_tools/body/builtin_body.h"
#include "data_tools/descriptors/person_frames.h"
#include "tests/support/short_track.h"

namespace bodyloom::freeze_track_test {
namespace {

using ::testing::ElementsAre;

TEST(FreezeTrack, ShowsOneFrameLonger) {
  EXPECT_THAT(FrozenAt(4, 1, 3), ElementsAre(0, 1, 1, 1, 1, 2, 3));
  EXPECT_THAT(FrozenAt(2, 1, 0), ElementsAre(0, 1));
  EXPECT_THROW(FrozenAt(4, 4, 1), std::invalid_argument);
  EXPECT_THROW(FrozenAt(4, -1, 1), std::invalid_argument);
  EXPECT_THROW(FrozenAt(4, 0, -1), std::invalid_argument);
}

TEST(PosedSpan, GoesFromTheFirstPoseToTheLast) {
  Motion motion = ShortTrack().motion;
  const int T = motion.num_frames();
  EXPECT_EQ(PosedSpan(motion), std::pair(0, T));
  motion.poses.row(0).setConstant(NAN);
  motion.trans.row(2).setConstant(NAN);  // a hole
  motion.poses.row(T - 1).setConstant(NAN);
  EXPECT_EQ(PosedSpan(motion), std::pair(1, T - 1));
  const Motion part = FramesOfMotion(motion, 1, T - 1);
  ASSERT_EQ(part.num_frames(), T - 2);
  EXPECT_EQ(part.poses.row(0), motion.poses.row(1));
  EXPECT_EQ(part.trans.row(T - 3), motion.trans.row(T - 2));
  EXPECT_EQ(part.timestamps.front(), motion.timestamps[1]);
  EXPECT_EQ(part.betas, motion.betas);
  motion.poses.setConstant(NAN);
  EXPECT_EQ(PosedSpan(motion), std::pair(0, 0));
  EXPECT_THROW(FramesOfMotion(motion, 2, 1), std::invalid_argument);
  EXPECT_THROW(FramesOfMotion(motion, 0, T + 1), std::invalid_argument);
}

TEST(FreezeTrack, TheClockGoesOn) {
  const Track track = ShortTrack();
  const Track shown = FramesInOrder(track, FrozenAt(track.num_frames(), 2, 3));
  ASSERT_EQ(shown.num_frames(), track.num_frames() + 3);
  const double frame_s = track.motion.timestamps[1] - track.motion.timestamps[0];
  for (int t = 0; t < shown.num_frames(); ++t) {
    const int from = t <= 2 ? t : std::max(2, t - 3);
    EXPECT_EQ(shown.motion.poses.row(t), track.motion.poses.row(from)) << t;
    EXPECT_EQ(shown.joints[t], track.joints[from]) << t;
    EXPECT_NEAR(shown.motion.timestamps[t], track.motion.timestamps[0] + t * frame_s, 1e-9) << t;
  }
  const std::vector<int> none = {0, track.num_frames()};
  EXPECT_THROW(FramesInOrder(track, none), std::invalid_argument);
}

TEST(FreezeTrack, AFrozenFrameMovesAsItDid) {
  const Track track = ShortTrack();
  PersonFramesOptions options;
  options.uv_size = 16;
  options.past = 3;
  options.window.max_side = 96;
  const PersonFrames plain(BuiltinBody(), track, options);
  options.shown = FrozenAt(track.num_frames(), 5, 2);
  const PersonFrames frozen(BuiltinBody(), track, options);
  ASSERT_EQ(frozen.num_frames(), track.num_frames() + 2);
  std::vector<float> expected(size_t(plain.channels()) * 16 * 16), maps = expected;
  double speed = 0;
  for (int t = 0; t < frozen.num_frames(); ++t) {
    plain.MotionMaps(options.shown[t], expected);
    frozen.MotionMaps(t, maps);
    EXPECT_EQ(maps, expected) << t;
    EXPECT_EQ(frozen.Segment(t), 0);
    if (t != 7) continue;
    for (size_t i = 3 * 16 * 16; i < maps.size(); ++i) speed += std::abs(maps[i]);
  }
  EXPECT_GT(speed, 1);  // nothing has come to rest

  // Seen from another side, it moves with the view.
  options.yaw_deg.assign(frozen.num_frames(), 0);
  options.yaw_deg[7] = 90;
  const PersonFrames turned(BuiltinBody(), track, options);
  plain.MotionMaps(5, expected);
  turned.MotionMaps(7, maps);
  for (size_t i = 0; i < 256; ++i) {
    for (const size_t map : {size_t{0}, size_t{3}, size_t{9}}) {
      // Turned by 90° about y: x comes from z, z from −x.
      EXPECT_NEAR(maps[(map + 0) * 256 + i], expected[(map + 2) * 256 + i], 1e-3);
      EXPECT_NEAR(maps[(map + 1) * 256 + i], expected[(map + 1) * 256 + i], 1e-3);
      EXPECT_NEAR(maps[(map + 2) * 256 + i], -expected[(map + 0) * 256 + i], 1e-3);
    }
  }
}

}  // namespace
}  // namespace bodyloom::freeze_track_test
