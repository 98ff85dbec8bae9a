// SPDX-License-Identifier: Apache-2.0
#include "tracking/camera_motion/points_floor.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "geometry/base/hash_random.h"
#include "geometry/base/units.h"

namespace bodyloom::points_floor_test {
namespace {

using Eigen::Vector3d;

const Vector3d kUp = Vector3d(0.1, -1, -0.2).normalized();
constexpr double kHeight = 0.4;

/// A floor of `on` points, a table 0.2 above it, and `aside` points of walls and things.
std::vector<Vector3d> Room(int on, int table, int aside, double noise, uint64_t seed) {
  HashRandom random(seed, {1});
  const Vector3d a = kUp.unitOrthogonal(), b = kUp.cross(a);
  std::vector<Vector3d> points;
  for (int i = 0; i < on + table; ++i) {
    const double height = i < on ? -kHeight : 0.2 - kHeight;
    const double along = random.Uniform(-1, 1), across = random.Uniform(-1, 1);
    const Vector3d at = height * kUp + along * a + across * b;
    points.push_back((1 + noise * random.Normal()) * at);
  }
  for (int i = 0; i < aside; ++i) {
    const double across = random.Uniform(-1, 1), above = random.Uniform(-kHeight, 1);
    const Vector3d wall = 1.2 * a + across * b + above * kUp;
    points.push_back((1 + noise * random.Normal()) * wall);
  }
  return points;
}

TEST(PointsFloor, IsExactWithoutNoiseAndBelowTheTable) {
  // The table has more points, yet the floor is below it.
  const PointsFloor floor = FindPointsFloor(Room(60, 90, 100, 0, 1), Vector3d(0, -1, 0));
  ASSERT_TRUE(floor.found) << floor.why;
  EXPECT_NEAR(floor.height, kHeight, 1e-6);
  EXPECT_LT((floor.up - kUp).norm(), 1e-6);
  EXPECT_NEAR(floor.HeightOf(0.3 * kUp), kHeight + 0.3, 1e-6);
}

TEST(PointsFloor, ErrorsAreWithinTheirSigma) {
  double of_height = 0, of_up = 0;
  constexpr int kSeeds = 20;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const PointsFloor floor = FindPointsFloor(Room(150, 30, 100, 0.01, uint64_t(seed)), Vector3d(0, -1, 0));
    ASSERT_TRUE(floor.found) << floor.why;
    of_height += std::pow((floor.height - kHeight) / floor.SigmaAt(Vector3d::Zero()), 2) / kSeeds;
    of_up += std::pow((floor.up - kUp).norm() / floor.UpSigma(), 2) / 2 / kSeeds;
  }
  // Independent errors count as correlated ones, which makes σ twice too large.
  EXPECT_LT(of_height, 1.5);
  EXPECT_GT(of_height, 0.1);
  EXPECT_LT(of_up, 1.5);
}

TEST(PointsFloor, ARoomWithoutItHasNone) {
  EXPECT_FALSE(FindPointsFloor(Room(0, 0, 200, 0.01, 1), Vector3d(0, -1, 0)).found);
  EXPECT_FALSE(FindPointsFloor(Room(12, 0, 0, 0.01, 1), Vector3d(0, -1, 0)).found);
  EXPECT_FALSE(FindPointsFloor({}, Vector3d(0, -1, 0)).found);
  // Seen by somebody who lies on the side, the floor is a wall.
  EXPECT_FALSE(FindPointsFloor(Room(150, 0, 0, 0.01, 1), Vector3d(1, 0, 0)).found);
  EXPECT_THROW(FindPointsFloor({}, Vector3d(0, -2, 0)), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::points_floor_test
