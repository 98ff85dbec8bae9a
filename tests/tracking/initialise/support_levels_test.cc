// SPDX-License-Identifier: Apache-2.0
// Heights at which somebody rests, against known ones: a box, a jogger, a climber, a path under a wrong vertical.
#include "tracking/initialise/support_levels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace bodyloom::support_levels_test {
namespace {

using Eigen::Vector3d;

constexpr double kRate = 15, kUpSigma = 0.06;
const Vector3d kUp(0, -1, 0);

/// The lowest point is at `height_m` (seconds) above y = −1, at x = `along_m`, with independent noise.
std::vector<LowestPoint> Points(
    double seconds, const std::function<double(double)>& height_m, double noise_m = 0,
    const std::function<double(double)>& along_m = [](double) { return 0.0; }, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  std::vector<LowestPoint> points;
  const double dt = 1 / kRate;
  for (double s = 0; s < seconds; s += dt) {
    const Vector3d place(along_m(s), 1 - height_m(s) + noise_m * normal(random), 4);
    const Vector3d moved(along_m(s + dt) - along_m(s - dt), height_m(s + dt) - height_m(s - dt), 0);
    points.push_back({s, place, moved.norm() / (2 * dt), true});
  }
  return points;
}

/// On the floor, up by 0.45 m onto a box at 3 s, for 2 s, and down again.
double OnBox(double s) {
  if (s < 3 || s > 5.8) return 0;
  if (s < 3.4) return 0.45 * (s - 3) / 0.4;
  return s < 5.4 ? 0.45 : 0.45 * (5.8 - s) / 0.4;
}

TEST(SupportLevels, FindsTheFloorAndABox) {
  const auto points = Points(8, OnBox, 0.01);
  const SupportLevels found = FindSupportLevels(points, kUp, kUpSigma);
  ASSERT_EQ(found.levels.size(), 2U) << found.why;
  EXPECT_NEAR(found.levels[0].level_m, -1, 0.01);
  EXPECT_NEAR(found.levels[1].level_m, -0.55, 0.01);
  EXPECT_NEAR(found.levels[1].seconds, 2, 0.3);
  ASSERT_EQ(found.of_frame.size(), points.size());
  for (size_t t = 0; t < points.size(); ++t) {
    const double s = points[t].seconds;
    if (s < 2.9 || s > 5.9) {
      EXPECT_EQ(found.of_frame[t], 0) << s;
    }
    if (s > 3.5 && s < 5.3) {
      EXPECT_EQ(found.of_frame[t], 1) << s;
    }
    // On the way nothing rests: a jump may end on the lower level.
    if (s > 3.1 && s < 3.3) {
      EXPECT_EQ(found.of_frame[t], 0) << s;
    }
  }
}

TEST(SupportLevels, AKnownLevelStaysTheFirst) {
  const auto points = Points(8, OnBox);
  const SupportLevels found = FindSupportLevels(points, kUp, kUpSigma, -1.03);
  ASSERT_EQ(found.levels.size(), 2U);
  EXPECT_EQ(found.levels[0].level_m, -1.03);
  EXPECT_TRUE(std::isnan(found.levels[0].sigma_m));
  EXPECT_NEAR(found.levels[1].level_m, -0.55, 0.002);
}

TEST(SupportLevels, WhoeverGlidesNeverRests) {
  const auto level = [](double) { return 0.0; };
  const auto along = [](double s) { return 0.8 * s; };
  const SupportLevels found = FindSupportLevels(Points(6, level, 0.01, along), kUp, kUpSigma);
  EXPECT_TRUE(found.levels.empty());
  EXPECT_EQ(found.why, "nothing is seen to rest for long enough");
}

/// A bed that is a spring: ±15 cm, at the top of which somebody falls freely.
TEST(SupportLevels, TheTopOfABounceIsNoLevel) {
  const double frequency = std::sqrt(9.81 / 0.15);
  const auto height = [=](double s) { return 0.15 * std::sin(frequency * s); };
  const SupportLevels found = FindSupportLevels(Points(6, height, 0.005), kUp, kUpSigma);
  ASSERT_EQ(found.levels.size(), 1U) << found.why;
  EXPECT_NEAR(found.levels[0].level_m, -1.15, 0.03);
}

/// Contacts of 0.2 s between flights of 0.2 s that rise by gt²/8 = 5 cm.
TEST(SupportLevels, FindsTheGroundOfAJogger) {
  const auto height = [](double s) {
    const double in = std::fmod(s, 0.4) - 0.2;
    return in < 0 ? 0.0 : 0.5 * 9.81 * in * (0.2 - in);
  };
  auto points = Points(3, height, 0.01);
  for (LowestPoint& point : points) point.speed_mps = std::fmod(point.seconds, 0.4) < 0.2 ? 0.3 : 3;
  const SupportLevels found = FindSupportLevels(points, kUp, kUpSigma);
  ASSERT_EQ(found.levels.size(), 1U) << found.why;
  EXPECT_NEAR(found.levels[0].level_m, -1, 0.02);
}

TEST(SupportLevels, LeavesClimbersRunnersWithoutRestAndWhoHangsAlone) {
  // Steps of 0.2 m, each for 0.4 s: who climbs rests at no height for long.
  const SupportLevels climbs = FindSupportLevels(Points(6, [](double s) { return 0.2 * std::floor(s / 0.4); }), kUp, 0);
  EXPECT_TRUE(climbs.levels.empty());
  EXPECT_EQ(climbs.why, "the body does not rest at one height");
  auto moves = Points(1, [](double) { return 0.0; });
  for (LowestPoint& point : moves) point.speed_mps = 4;
  EXPECT_EQ(FindSupportLevels(moves, kUp, kUpSigma).why, "nothing is seen to rest for long enough");
  auto hangs = Points(5, [](double) { return 0.3; });
  for (LowestPoint& point : hangs) point.supports = false;
  EXPECT_TRUE(FindSupportLevels(hangs, kUp, kUpSigma).levels.empty());
  EXPECT_TRUE(FindSupportLevels({}, kUp, kUpSigma).levels.empty());
}

/// A walk of 8 m after 6 s and before 3 s of standing, under a vertical that is 3° wrong: its far end is 42 cm higher.
TEST(SupportLevels, ASlopeThatTheVerticalExplainsIsNoLevel) {
  const auto along = [](double s) { return s < 6 ? 0.0 : s < 10 ? 2 * (s - 6) : 8.0; };
  const auto points = Points(
      13, [&](double s) { return along(s) * std::tan(3 * M_PI / 180); }, 0, along);
  EXPECT_EQ(FindSupportLevels(points, kUp, kUpSigma).levels.size(), 1U);
  EXPECT_EQ(FindSupportLevels(points, kUp, 0.005).levels.size(), 2U) << "a vertical that is surely right leaves a step";
}

/// The stated σ covers: the noise of a second's frames is common to them.
TEST(SupportLevels, SigmaCovers) {
  int within = 0, count = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    std::mt19937 random(1000 + seed);
    std::normal_distribution<double> normal(0, 1);
    std::vector<double> slow(8);
    for (double& value : slow) value = 0.02 * normal(random);
    const auto points = Points(
        4, [&](double s) { return slow[static_cast<size_t>(2 * s)]; }, 0.01, [](double) { return 0.0; }, seed);
    auto still = points;
    for (LowestPoint& point : still) point.speed_mps = 0.1;
    const SupportLevels found = FindSupportLevels(still, kUp, kUpSigma);
    ASSERT_FALSE(found.levels.empty());
    ++count;
    within += std::abs(found.levels[0].level_m + 1) <= 2 * found.levels[0].sigma_m ? 1 : 0;
  }
  EXPECT_GE(within, 0.9 * count) << within << " of " << count;
}

}  // namespace
}  // namespace bodyloom::support_levels_test
