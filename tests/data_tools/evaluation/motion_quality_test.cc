// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/motion_quality.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "data_tools/motion/motion_floor.h"
#include "data_tools/motion/motion_sheet.h"
#include "render/image/palette.h"
#include "tests/data_tools/motion/motion_support.h"

namespace bodyloom::motion_quality_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(MotionQuality, AWalkIsSound) {
  const MotionQuality quality = MeasureMotionQuality(WalkingMotion(60, 3), true);
  EXPECT_EQ(quality.frames, 181);
  EXPECT_NEAR(quality.fps, 60, 1e-9);
  EXPECT_NEAR(quality.seconds, 3, 1e-9);
  EXPECT_LT(quality.foot_sliding_m_s, 0.1) << "the bearing foot stands still";
  EXPECT_GT(quality.contact_share, 0.8);
  EXPECT_EQ(quality.beyond_limits_share, 0);
  EXPECT_EQ(quality.flips + quality.ends_flips, 0);
  EXPECT_THAT(quality.flags, IsEmpty());
}

TEST(MotionQuality, SlidingSinkingAndHangingUpsideDownAreSeen) {
  Motion motion = StandingMotion(50, 2);
  for (int t = 0; t < motion.num_frames(); ++t) motion.trans(t, 2) = 0.5 * motion.timestamps[t];
  MotionQuality quality = MeasureMotionQuality(motion, true);
  EXPECT_NEAR(quality.foot_sliding_m_s, 0.5, 1e-9);
  EXPECT_NEAR(quality.foot_sliding_p95_m_s, 0.5, 1e-9);
  EXPECT_THAT(quality.flags, ElementsAre("foot_sliding"));
  EXPECT_TRUE(std::isnan(MeasureMotionQuality(motion, false).foot_sliding_m_s));

  motion = StandingMotion(50, 2);
  motion.trans.col(1).array() -= 0.08;
  quality = MeasureMotionQuality(motion, true);
  EXPECT_NEAR(quality.sunk_share, 1, 1e-9);
  EXPECT_NEAR(quality.deepest_m, 0.08, 1e-9);
  EXPECT_THAT(quality.flags, ElementsAre("sunk"));

  motion = StandingMotion(50, 2);
  motion.poses.col(2).setConstant(M_PI);
  EXPECT_THAT(MeasureMotionQuality(motion, false).flags, ElementsAre("upside_down"));
}

TEST(MotionQuality, LimitsOfTheBodyAndOfTheEndsApart) {
  Motion motion = StandingMotion(50, 1);
  for (int t = 0; t < 10; ++t) motion.poses(t, 3 * 4) = -0.10 - 20 * M_PI / 180;  // a knee 20° beyond straight
  MotionQuality quality = MeasureMotionQuality(motion, true);
  EXPECT_NEAR(quality.beyond_limits_share, 10.0 / 51, 1e-9);
  EXPECT_NEAR(quality.worst_excess_deg, 20, 1e-6);
  EXPECT_EQ(quality.worst_excess_joint, "l_knee");
  EXPECT_EQ(quality.ends_beyond_limits_share, 0);
  motion = StandingMotion(50, 1);
  motion.poses.col(3 * 20 + 1).setConstant(1.0 + 10 * M_PI / 180);  // a wrist, always
  quality = MeasureMotionQuality(motion, true);
  EXPECT_EQ(quality.beyond_limits_share, 0);
  EXPECT_NEAR(quality.ends_beyond_limits_share, 1, 1e-9);
  EXPECT_EQ(quality.ends_worst_excess_joint, "l_wrist");
  EXPECT_THAT(quality.flags, ElementsAre("ends"));
}

TEST(MotionQuality, AFlipTurnsBackAFastTurnDoesNot) {
  Motion motion = StandingMotion(50, 1);
  motion.poses(20, 3 * 18 + 1) = -0.5;  // 25 rad/s there and back
  EXPECT_EQ(MeasureMotionQuality(motion, true).flips, 1);
  motion = StandingMotion(50, 1);
  for (int t = 20; t < motion.num_frames(); ++t) motion.poses(t, 3 * 18 + 1) = -0.5 * std::min(t - 19, 3);
  const MotionQuality quality = MeasureMotionQuality(motion, true);
  EXPECT_EQ(quality.flips, 0);
  EXPECT_NEAR(quality.worst_turn_rad_s, 25, 1e-6);
  EXPECT_EQ(quality.worst_turn_joint, "l_elbow");
}

TEST(MotionQuality, SpeedsAndAccelerationsAreThoseOfTheMotion) {
  Motion motion = StandingMotion(100, 1);
  for (int t = 0; t < motion.num_frames(); ++t) {
    motion.trans(t, 1) += 4 * motion.timestamps[t] - 4.905 * motion.timestamps[t] * motion.timestamps[t];  // a throw
  }
  const MotionQuality quality = MeasureMotionQuality(motion, false);
  EXPECT_NEAR(quality.worst_acceleration_m_s2, 9.81, 1e-6);
  EXPECT_NEAR(quality.worst_speed_m_s, 0, 1e-9) << "relative to the pelvis nothing moves";
}

TEST(MotionQuality, RefusesWhatItCannotMeasure) {
  Motion motion = StandingMotion(50, 1);
  motion.timestamps.back() += 1;
  EXPECT_THROW(MeasureMotionQuality(motion, true), std::invalid_argument);
  EXPECT_THROW(MeasureMotionQuality(StandingMotion(50, 0), true), std::invalid_argument);
}

TEST(MotionFloor, StairsHaveNoneAndAJumpHasOne) {
  Motion stairs = StandingMotion(60, 4);
  for (int t = 0; t < stairs.num_frames(); ++t)
    stairs.trans(t, 1) += 0.17 * std::min(3.0, std::floor(stairs.timestamps[t] / 0.5));
  FloorEstimate floor = EstimateFloor(std::span(&stairs, 1));
  EXPECT_FALSE(floor.has_floor);
  EXPECT_NEAR(floor.height_m, 0, 0.02) << "the lowest level";
  EXPECT_LT(floor.flat_share, 0.7);

  Motion jump = StandingMotion(60, 4);
  for (int t = 0; t < jump.num_frames(); ++t) {
    const double s = jump.timestamps[t] - 1;
    if (s > 0 && s < 0.6) jump.trans(t, 1) += 4.905 * s * (0.6 - s);
  }
  floor = EstimateFloor(std::span(&jump, 1));
  EXPECT_TRUE(floor.has_floor);
  EXPECT_NEAR(floor.height_m, 0, 1e-6);
}

TEST(MotionFloor, ASunkFrameDoesNotMoveItNorFlightWithoutSupportFoolIt) {
  Motion motion = StandingMotion(60, 4);
  for (int t = 100; t < 103; ++t) motion.trans(t, 1) -= 0.3;
  EXPECT_NEAR(EstimateFloor(std::span(&motion, 1)).height_m, 0, 1e-6);
  Motion flying = StandingMotion(60, 1);
  for (int t = 0; t < flying.num_frames(); ++t) flying.trans(t, 0) = 5 * flying.timestamps[t];
  const FloorEstimate floor = EstimateFloor(std::span(&flying, 1));
  EXPECT_FALSE(floor.has_floor);
  EXPECT_EQ(floor.support_s, 0);
  EXPECT_NEAR(floor.height_m, 0, 1e-9);
}

/// Mean x of the pixels near a colour in rows [top, bottom).
double MeanX(const Image& image, Colour colour, int top, int bottom) {
  double sum = 0;
  int count = 0;
  for (int y = top; y < bottom; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (image.at(x, y) == colour) {
        sum += x;
        ++count;
      }
    }
  }
  return count > 0 ? sum / count : NAN;
}

TEST(MotionSheet, LeftIsOnTheRightSeenFromTheFrontWhateverTheHeading) {
  for (const double heading : {0.0, 2.0, -1.2}) {
    Motion motion = StandingMotion(50, 0.1);
    motion.poses.col(1).setConstant(heading);
    const Image strip = DrawMotionStrip(motion, true, "a clip", {.instants = 1, .figure_width_px = 100, .columns = 1});
    const int rows_begin = 18, row_px = 125;
    EXPECT_EQ(strip.height, rows_begin + 2 * row_px);
    EXPECT_GT(MeanX(strip, kLeftColour, rows_begin, rows_begin + row_px), 55) << heading;
    EXPECT_LT(MeanX(strip, kRightColour, rows_begin, rows_begin + row_px), 45) << heading;
  }
}

TEST(MotionSheet, SeenFromTheLeftTheRaisedFootIsInFront) {
  Motion motion = StandingMotion(50, 0.1);
  motion.poses.col(3).setConstant(-1.5);  // the left leg lifted to the front
  const Image strip = DrawMotionStrip(motion, true, "a clip", {.instants = 1, .figure_width_px = 100, .columns = 1});
  EXPECT_LT(MeanX(strip, kLeftColour, 18 + 125 + 50, strip.height), 45) << "front is left in the lower row";
  const Image sheet = MotionSheet({strip, strip, strip}, {.instants = 1, .figure_width_px = 100, .columns = 2});
  EXPECT_EQ(sheet.width, 2 * 108 + 8);
  EXPECT_EQ(sheet.height, 2 * (strip.height + 8) + 8);
  EXPECT_THROW(MotionSheet({}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::motion_quality_test
