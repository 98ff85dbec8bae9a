// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/balance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace bodyloom::balance_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const std::vector<Vector2d> kSquare = {{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}};

/// A clip at 30 Hz that stands on the square; `centre(t)` is its centre of mass.
template <typename Path>
std::vector<SupportedFrame> Clip(int num_frames, const Path& centre) {
  std::vector<SupportedFrame> frames;
  for (int t = 0; t < num_frames; ++t) frames.push_back({t / 30.0, centre(t / 30.0), kSquare, t > 0});
  return frames;
}

TEST(ConvexHull, OfPointsInASquareIsTheSquare) {
  std::vector<Vector2d> points = kSquare;
  for (const double x : {-0.1, -0.05, 0.0, 0.1}) {
    for (const double y : {-0.1, 0.0, 0.07, 0.1}) points.emplace_back(x, y);
  }
  const std::vector<Vector2d> hull = ConvexHull(points);
  ASSERT_EQ(hull.size(), 4U);
  double area = 0;
  for (size_t k = 0; k < 4; ++k) {
    const Vector2d a = hull[k], b = hull[(k + 1) % 4];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  EXPECT_NEAR(area, 0.04, 1e-15) << "positive: counter-clockwise";
}

TEST(ConvexHull, HoldsAllItsPoints) {
  std::vector<Vector2d> points;
  for (int k = 0; k < 60; ++k) points.emplace_back(std::sin(37.0 * k), std::cos(11.0 * k) * std::sin(5.0 * k));
  const std::vector<Vector2d> hull = ConvexHull(points);
  for (const Vector2d& point : points) EXPECT_LT(DistanceOutside(hull, point), 1e-12);
  for (const Vector2d& corner : hull) EXPECT_GT(DistanceOutside(hull, 1.01 * corner), 0);
}

TEST(ConvexHull, OfFewPointsIsAPointOrALine) {
  EXPECT_EQ(ConvexHull({{1, 2}, {1, 2}}).size(), 1U);
  EXPECT_EQ(ConvexHull({{0, 0}, {1, 1}, {0.5, 0.5}, {2, 2}}).size(), 2U);
  EXPECT_NEAR(DistanceOutside({{1, 2}}, {4, 6}), 5, 1e-15);
  EXPECT_NEAR(DistanceOutside({{0, 0}, {2, 0}}, {1, -0.3}), 0.3, 1e-15);
  EXPECT_NEAR(DistanceOutside({{0, 0}, {2, 0}}, {1, 0}), 0, 1e-15);
  EXPECT_THROW(DistanceOutside({}, {0, 0}), std::invalid_argument);
}

TEST(DistanceOutside, IsZeroInsideAndGrowsFromTheNearestEdgeOrCorner) {
  EXPECT_EQ(DistanceOutside(kSquare, {0.05, -0.09}), 0);
  EXPECT_NEAR(DistanceOutside(kSquare, {0.4, 0.03}), 0.3, 1e-15);
  EXPECT_NEAR(DistanceOutside(kSquare, {0.4, -0.5}), 0.5, 1e-15);
}

TEST(Balance, IsTheDistanceOfTheCentreFromTheFeetAtRest) {
  const Balance upright = MeasureBalance(Clip(60, [](double) { return Vector3d(0.02, 1, 0); }));
  EXPECT_EQ(upright.frames, 60 - 2 * 5) << "0.15 s are 4.5 frames, and a window ends where another frame follows";
  EXPECT_EQ(upright.outside_share, 0);
  EXPECT_NEAR(upright.outside_p95_m, 0, 1e-12);
  // 30 cm outside the feet: less the 4 cm of the widened hull.
  const Balance pushed = MeasureBalance(Clip(60, [](double) { return Vector3d(0.1 + 0.3, 1, 0); }));
  EXPECT_EQ(pushed.outside_share, 1);
  EXPECT_NEAR(pushed.outside_p95_m, 0.26, 1e-12);
}

TEST(Balance, WhoSwaysIsSupportedWhereHeAccelerates) {
  // x = 0.15 + t²/2 · 1.2: outside by 5 cm at t = 0, but pushed by feet that lie 0.12 m behind it.
  const auto sway = [](double t) { return Vector3d(0.15 + 0.6 * (t - 1) * (t - 1), 0.981, 0); };
  std::vector<SupportedFrame> frames = Clip(61, sway);
  for (int t = 0; t < 61; ++t) {
    if (t != 30) frames[size_t(t)].contacts.clear();
  }
  const Balance balance = MeasureBalance(frames);
  EXPECT_EQ(balance.frames, 1);
  EXPECT_NEAR(balance.outside_p95_m, 0, 1e-9) << "p = 0.15 − 0.981 / 9.81 · 1.2 = 0.03";
  for (SupportedFrame& frame : frames) frame.centre_of_mass.x() += 0.2;
  EXPECT_NEAR(MeasureBalance(frames).outside_p95_m, 0.23 - 0.1 - 0.04, 1e-9);
}

TEST(Balance, ABallThatFallsIsNoStandingBody) {
  const auto fall = [](double t) { return Vector3d(2, 5 - 0.5 * 9.81 * t * t, 0); };
  EXPECT_EQ(MeasureBalance(Clip(30, fall)).frames, 0);
  EXPECT_TRUE(std::isnan(MeasureBalance(Clip(30, fall)).outside_share));
  // The same path slowed down to 1.4 m/s² is measured: 9.81 is what the fit found, not a failed one.
  const auto sink = [](double t) { return Vector3d(2, 5 - 0.5 * 1.4 * t * t, 0); };
  EXPECT_EQ(MeasureBalance(Clip(30, sink)).frames, 20);
}

TEST(Balance, SlowClipsOfFewFramesASecondAreMeasuredByTheirNeighbours) {
  const auto at = [](double rate) {
    std::vector<SupportedFrame> frames = Clip(12, [](double) { return Vector3d(0.4, 1, 0); });
    for (size_t t = 0; t < frames.size(); ++t) frames[t].seconds = static_cast<double>(t) / rate;
    return MeasureBalance(frames);
  };
  EXPECT_EQ(at(5).frames, 10);
  EXPECT_NEAR(at(5).outside_p95_m, 0.26, 1e-12);
  EXPECT_EQ(at(3).frames, 0);
}

TEST(Balance, GapsAndFramesWithoutContactAreLeftOut) {
  std::vector<SupportedFrame> frames = Clip(60, [](double) { return Vector3d(0, 1, 0); });
  for (int t = 20; t < 60; ++t) frames[size_t(t)].seconds += 0.2;
  frames[20].continues = false;
  EXPECT_EQ(MeasureBalance(frames).frames, 60 - 4 * 5);
  for (int t = 30; t < 40; ++t) frames[size_t(t)].contacts.clear();
  EXPECT_EQ(MeasureBalance(frames).frames, 60 - 4 * 5 - 10);
  EXPECT_EQ(MeasureBalance({}).frames, 0);
}

}  // namespace
}  // namespace bodyloom::balance_test
