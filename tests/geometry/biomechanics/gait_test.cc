// SPDX-License-Identifier: Apache-2.0
#include "geometry/biomechanics/gait.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "geometry/math/rotation.h"

namespace bodyloom::gait_test {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr double kLeg_m = 0.9, kFps = 30;

/// Feet that stand still for `stance` of a stride and swing forward for the rest, under hips that move evenly; the
/// body goes along −z, its left is −x.
struct Walker {
  double stride_s = 1.1, speed_mps = 1.2, stance = 0.62, seconds = 6, first_s = 0.5;
  bool on_the_spot = false;  ///< the world moves under the body, as on a treadmill

  [[nodiscard]] double Stride() const { return speed_mps * stride_s; }
  /// Start of the foot's k-th stance.
  [[nodiscard]] double StrikeAt(int foot, int k) const { return first_s + stride_s * (k + 0.5 * foot); }
  [[nodiscard]] double OffAt(int foot, int k) const { return StrikeAt(foot, k) + stance * stride_s; }

  /// The ankle's way along the path. In mid-stance it is under the hips.
  [[nodiscard]] double AnkleAlong(int foot, double t) const {
    const int k = static_cast<int>(std::floor((t - StrikeAt(foot, 0)) / stride_s));
    const double place = speed_mps * (StrikeAt(foot, k) + 0.5 * stance * stride_s);
    const double swing = (t - OffAt(foot, k)) / ((1 - stance) * stride_s);
    return swing <= 0 ? place : place + Stride() * swing * swing * (3 - 2 * swing);
  }

  [[nodiscard]] GaitPlaces Places() const {
    GaitPlaces places;
    places.leg_length_m = kLeg_m;
    const int T = static_cast<int>(seconds * kFps);
    for (const size_t foot : {0, 1}) {
      for (MatrixX3d* of : {&places.hips[foot], &places.ankles[foot], &places.balls[foot]}) of->resize(T, 3);
    }
    for (int t = 0; t < T; ++t) {
      const double time = t / kFps, back = on_the_spot ? speed_mps * time : 0;
      places.timestamps.push_back(time + 2);
      for (const int foot : {0, 1}) {
        const double side = foot == 0 ? -0.1 : 0.1, ankle = AnkleAlong(foot, time) - back;
        places.hips[size_t(foot)].row(t) << side, 0.95, -(speed_mps * time - back);
        places.ankles[size_t(foot)].row(t) << side, 0.08, -ankle;
        places.balls[size_t(foot)].row(t) << side, 0.02, -(ankle + 0.13);
      }
    }
    return places;
  }
};

GaitPlaces Moved(GaitPlaces places, const Eigen::Matrix3d& rotation, const Vector3d& by) {
  for (const size_t foot : {0, 1}) {
    for (MatrixX3d* of : {&places.hips[foot], &places.ankles[foot], &places.balls[foot]}) {
      *of = ((*of * rotation.transpose()).rowwise() + by.transpose()).eval();
    }
  }
  return places;
}

TEST(Gait, EventsAndFiguresOfAWalkAreThoseItWasMadeWith) {
  const Walker walker;
  const GaitReport gait = AnalyseGait(walker.Places());
  ASSERT_TRUE(gait.walks) << gait.reason;
  EXPECT_NEAR(gait.cadence_per_min, 120 / walker.stride_s, 0.5);
  EXPECT_NEAR(gait.step_time_s, 0.5 * walker.stride_s, 0.003);
  EXPECT_NEAR(gait.speed_mps, walker.speed_mps, 0.01);
  for (const double length : gait.step_length_m) EXPECT_NEAR(length, 0.5 * walker.Stride(), 0.02);
  EXPECT_NEAR(gait.mean_step_length_m() * gait.cadence_per_min / 60, gait.speed_mps, 0.02);
  EXPECT_GE(gait.num_steps, 7);
  ASSERT_EQ(gait.bouts_s.size(), 1U);
  int strikes = 0, offs = 0;
  for (const GaitEvent& event : gait.events) {
    const bool strike = event.kind == GaitEventKind::kFootStrike;
    double nearest = std::numeric_limits<double>::infinity();
    for (int k = -1; k < 7; ++k) {
      const int foot = static_cast<int>(event.foot);
      const double truly = strike ? walker.StrikeAt(foot, k) : walker.OffAt(foot, k);
      if (std::abs(event.seconds - 2 - truly) < std::abs(nearest)) nearest = event.seconds - 2 - truly;
    }
    // The header's bias: strikes come up to 0.04 s early, offs late.
    EXPECT_LT(std::abs(nearest), 0.045);
    EXPECT_NEAR(event.frame, (event.seconds - 2) * kFps, 1.01);
    (strike ? strikes : offs) += 1;
  }
  EXPECT_EQ(strikes, gait.num_steps + 1);
  EXPECT_GE(offs, gait.num_steps - 1);
  EXPECT_TRUE(std::is_sorted(gait.events.begin(), gait.events.end(),
                             [](const GaitEvent& a, const GaitEvent& b) { return a.seconds < b.seconds; }));
  EXPECT_THAT(gait.BriefReport(), HasSubstr("walking, "));
}

TEST(Gait, PlaceAndHeadingDoNotMatterAndTheMirrorSwapsTheFeet) {
  const GaitReport one = AnalyseGait(Walker().Places());
  const GaitReport moved =
      AnalyseGait(Moved(Walker().Places(), RotationFromAxisAngle({0, 1.9, 0}), Vector3d(3, 0.2, -7)));
  ASSERT_EQ(moved.events.size(), one.events.size());
  for (size_t i = 0; i < one.events.size(); ++i) {
    EXPECT_EQ(moved.events[i].foot, one.events[i].foot);
    EXPECT_NEAR(moved.events[i].seconds, one.events[i].seconds, 1e-6);
  }
  GaitPlaces mirrored = Moved(Walker().Places(), Vector3d(-1, 1, 1).asDiagonal(), Vector3d::Zero());
  std::swap(mirrored.hips[0], mirrored.hips[1]);
  std::swap(mirrored.ankles[0], mirrored.ankles[1]);
  std::swap(mirrored.balls[0], mirrored.balls[1]);
  const GaitReport other = AnalyseGait(mirrored);
  ASSERT_EQ(other.events.size(), one.events.size());
  for (size_t i = 0; i < one.events.size(); ++i) EXPECT_NE(other.events[i].foot, one.events[i].foot);
  EXPECT_NEAR(other.step_length_m[0], one.step_length_m[1], 1e-9);
}

TEST(Gait, WhoDoesNotWalkHasNoStepsAndAReason) {
  const auto reason = [](const GaitPlaces& places) {
    const GaitReport gait = AnalyseGait(places);
    EXPECT_FALSE(gait.walks);
    EXPECT_TRUE(gait.events.empty());
    EXPECT_EQ(gait.num_steps, 0);
    EXPECT_TRUE(std::isnan(gait.cadence_per_min) && std::isnan(gait.speed_mps) && std::isnan(gait.step_length_m[0]));
    EXPECT_THAT(gait.BriefReport(), HasSubstr("no walking: " + gait.reason));
    return gait.reason;
  };
  Walker treadmill;
  treadmill.on_the_spot = true;
  EXPECT_THAT(reason(treadmill.Places()), HasSubstr("does not move as fast"));
  Walker runner;
  runner.stance = 0.25;
  runner.stride_s = 0.8;
  runner.speed_mps = 2;
  EXPECT_THAT(reason(runner.Places()), HasSubstr("running"));
  runner.speed_mps = 3.5;
  EXPECT_THAT(reason(runner.Places()), HasSubstr("moves faster"));
  GaitPlaces backwards = Walker().Places();
  std::swap(backwards.hips[0], backwards.hips[1]);
  EXPECT_THAT(reason(backwards), HasSubstr("sideways or backwards"));
  GaitPlaces sliding = Walker().Places();
  sliding.ankles = sliding.balls = sliding.hips;
  EXPECT_THAT(reason(sliding), HasSubstr("do not strike in turn"));
  Walker brief;
  brief.seconds = 0.8;
  EXPECT_THAT(reason(brief.Places()), HasSubstr("no stretch of a second"));
  GaitPlaces lost = Walker().Places();
  lost.hips[0].setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(reason(lost), HasSubstr("no stretch of a second"));
  EXPECT_THAT(reason(GaitPlaces{{}, {}, {}, {}, 0.9}), HasSubstr("no stretch"));
}

TEST(Gait, NothingIsMeasuredAcrossAGap) {
  Walker walker;
  walker.seconds = 12;
  GaitPlaces places = walker.Places();
  for (int t = 170; t < 185; ++t) places.ankles[1].row(t).setConstant(std::numeric_limits<double>::quiet_NaN());
  GaitReport gait = AnalyseGait(places);
  ASSERT_EQ(gait.bouts_s.size(), 2U);
  EXPECT_LT(gait.bouts_s[0].second, places.timestamps[170]);
  EXPECT_GT(gait.bouts_s[1].first, places.timestamps[184]);
  EXPECT_NEAR(gait.cadence_per_min, 120 / walker.stride_s, 0.5);

  places = walker.Places();
  for (size_t t = 180; t < places.timestamps.size(); ++t) places.timestamps[t] += 0.5;  // frames that are not there
  gait = AnalyseGait(places);
  EXPECT_EQ(gait.bouts_s.size(), 2U);
}

TEST(Gait, SizesThatDifferAreRefused) {
  GaitPlaces places = Walker().Places();
  places.balls[1].conservativeResize(3, 3);
  EXPECT_THROW(AnalyseGait(places), std::invalid_argument);
  places = Walker().Places();
  places.leg_length_m = 0;
  EXPECT_THROW(AnalyseGait(places), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::gait_test
