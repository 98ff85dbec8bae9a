// SPDX-License-Identifier: Apache-2.0
// Projection of a point with its derivatives, the place of a camera and of a point.
#include "tracking/camera_motion/projected_point.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "geometry/math/rotation.h"

namespace bodyloom::projected_point_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFocal = 900;

Vector2d Projected(const CameraPlace& camera, const Vector3d& point) {
  const Vector3d in_camera = RotationFromAxisAngle(camera.w) * (point - camera.centre);
  return kFocal * in_camera.head<2>() / in_camera.z();
}

TEST(ProjectedPointCost, DerivativesAreThoseOfDifferences) {
  // Generic; no rotation; a large turn; a zero residual.
  const std::vector<std::array<Vector3d, 2>> cameras = {{{{0.1, -0.2, 0.05}, {0.3, 0.1, -0.2}}},
                                                        {{Vector3d::Zero(), Vector3d::Zero()}},
                                                        {{{0, 2.2, 0.1}, {0.2, 0, 8}}},
                                                        {{{0.02, 0.01, 0}, {1, 0, 0}}}};
  for (size_t n = 0; n < cameras.size(); ++n) {
    const auto& [w, centre] = cameras[n];
    const Vector3d point = RotationFromAxisAngle(w).transpose() * Vector3d(0.8, -0.5, 4) + centre;
    const Vector2d exact = Projected({w, centre}, point);
    const ProjectedPointCost cost(n == 3 ? exact : Vector2d(exact + Vector2d(11, -7)), 0.7);
    std::array<double, 10> x = {w.x(),      w.y(),     w.z(),     centre.x(), centre.y(),
                                centre.z(), point.x(), point.y(), point.z(),  std::log(kFocal)};
    const std::array<const double*, 4> blocks = {&x[0], &x[3], &x[6], &x[9]};
    std::array<std::array<double, 6>, 4> jacobians{};
    std::array<double*, 4> pointers{};
    for (size_t b = 0; b < 4; ++b) pointers[b] = jacobians[b].data();
    std::array<double, 2> residuals{}, above{}, below{};
    ASSERT_TRUE(cost.Evaluate(blocks.data(), residuals.data(), pointers.data()));
    EXPECT_NEAR(std::hypot(residuals[0], residuals[1]), n == 3 ? 0 : std::hypot(11, 7) / 0.7, 1e-9);
    const std::array<size_t, 4> first = {0, 3, 6, 9}, size = {3, 3, 3, 1};
    for (size_t b = 0; b < 4; ++b) {
      for (size_t k = 0; k < size[b]; ++k) {
        double& at = x[first[b] + k];
        const double before = at, step = 1e-6;
        at = before + step;
        ASSERT_TRUE(cost.Evaluate(blocks.data(), above.data(), nullptr));
        at = before - step;
        ASSERT_TRUE(cost.Evaluate(blocks.data(), below.data(), nullptr));
        at = before;
        for (size_t r = 0; r < 2; ++r) {
          const double expected = (above[r] - below[r]) / (2 * step);
          EXPECT_NEAR(jacobians[b][r * size[b] + k], expected, 1e-5 * (1 + std::abs(expected)))
              << n << ": block " << b << ", " << k << ", row " << r;
        }
      }
    }
  }
}

TEST(ProjectedPointCost, APointBehindTheCameraIsNotValid) {
  const ProjectedPointCost cost({10, 20}, 1);
  const std::array<double, 3> zero{}, half_turn = {0, M_PI, 0}, point = {0.1, 0.1, 2};
  const double log_focal = 7;
  const std::array<const double*, 4> behind = {half_turn.data(), zero.data(), point.data(), &log_focal};
  std::array<double, 2> residuals{};
  EXPECT_FALSE(cost.Evaluate(behind.data(), residuals.data(), nullptr));
  const std::array<const double*, 4> before = {zero.data(), zero.data(), point.data(), &log_focal};
  EXPECT_TRUE(cost.Evaluate(before.data(), residuals.data(), nullptr));
  EXPECT_TRUE(std::isinf(ProjectionDistance({{0, M_PI, 0}, Vector3d::Zero()}, kFocal, {{0.1, 0.1, 2}, {0, 0}})));
}

/// Points 3 to 9 m before a camera, which a share of sees elsewhere.
std::vector<PointInPicture> Seen(const CameraPlace& camera, double noise_px, double elsewhere, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::vector<PointInPicture> seen;
  for (int i = 0; i < 80; ++i) {
    const double x = uniform(random) - 0.5, y = uniform(random) - 0.5, depth = 3 + 6 * uniform(random);
    PointInPicture& point = seen.emplace_back();
    point.point = RotationFromAxisAngle(camera.w).transpose() * (depth * Vector3d(x, y, 1)) + camera.centre;
    const double off_x = normal(random), off_y = normal(random);
    point.pixel = Projected(camera, point.point) + noise_px * Vector2d(off_x, off_y);
    if (uniform(random) < elsewhere) point.pixel += Vector2d(60, -40) * (1 + uniform(random));
  }
  return seen;
}

TEST(FitCameraPlace, FindsThePlaceAmongPointsThatMoveByThemselves) {
  const CameraPlace camera{{0.2, -0.4, 0.1}, {1, -0.5, 2}};
  const CameraPlace start{{0.15, -0.3, 0.05}, {0.8, -0.4, 1.8}};
  const auto exact = FitCameraPlace(Seen(camera, 0, 0.3, 1), kFocal, 0.3, start);
  ASSERT_TRUE(exact);
  EXPECT_LT((exact->place.centre - camera.centre).norm(), 1e-2);
  double normal = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const auto fit = FitCameraPlace(Seen(camera, 0.3, 0.2, seed), kFocal, 0.3, start);
    ASSERT_TRUE(fit);
    EXPECT_GT(fit->num_good, 50);
    EXPECT_LT(fit->num_good, 78);
    const Vector3d off = fit->place.centre - camera.centre;
    normal += off.dot(fit->covariance.bottomRightCorner<3, 3>().inverse() * off) / (3 * 20);
  }
  EXPECT_GT(std::sqrt(normal), 0.5);
  EXPECT_LT(std::sqrt(normal), 2);
}

TEST(FitCameraPlace, NeedsPointsThatAgree) {
  const CameraPlace camera;
  const std::vector<PointInPicture> seen = Seen(camera, 0, 0, 1);
  EXPECT_FALSE(FitCameraPlace({seen.data(), 5}, kFocal, 0.3, camera));
  EXPECT_FALSE(FitCameraPlace({}, kFocal, 0.3, camera));
  std::vector<PointInPicture> nonsense = seen;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0, 200);
  for (PointInPicture& point : nonsense) {
    const double x = normal(random), y = normal(random);
    point.pixel = {x, y};
  }
  const auto fit = FitCameraPlace(nonsense, kFocal, 0.3, camera);
  EXPECT_TRUE(!fit || fit->num_good < 20);
  // All of them behind.
  EXPECT_FALSE(FitCameraPlace(seen, kFocal, 0.3, {{0, M_PI, 0}, Vector3d::Zero()}));
}

TEST(FitPoint, FindsThePlaceAndTheAngle) {
  const Vector3d point(0.5, -0.2, 5);
  std::vector<PixelOfCamera> seen;
  for (const double x : {0.0, 0.3, 0.6}) {
    const CameraPlace camera{{0, 0.02 * x, 0}, {x, 0, 0}};
    seen.push_back({camera, Projected(camera, point)});
  }
  const auto fit = FitPoint(seen, kFocal, 0.3, 1.5, 100);
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->point - point).norm(), 1e-6);
  const Vector3d a = point, b = point - Vector3d(0.6, 0, 0);
  EXPECT_NEAR(fit->angle, std::acos(a.dot(b) / (a.norm() * b.norm())), 1e-9);
  // One of four pixels is of another point.
  seen.push_back({{{0, 0, 0}, {0.9, 0, 0}}, Projected({{0, 0, 0}, {0.9, 0, 0}}, point) + Vector2d(0, 80)});
  const auto robust = FitPoint(seen, kFocal, 0.3, 1.5, 100);
  ASSERT_TRUE(robust);
  EXPECT_LT((robust->point - point).norm(), 0.05);
}

TEST(FitPoint, FarPointsStayInReachAndRaysThatDoNotMeetHaveNone) {
  const CameraPlace first, second{{0, 0, 0}, {0.1, 0, 0}};
  const auto far = FitPoint(std::vector<PixelOfCamera>{{first, {30, 40}}, {second, {30, 40}}}, kFocal, 0.3, 1.5, 100);
  ASSERT_TRUE(far);
  EXPECT_NEAR(far->point.norm(), 100, 1);
  EXPECT_FALSE(FitPoint(std::vector<PixelOfCamera>{{first, {30, 40}}, {second, {-30, 90}}}, kFocal, 0.3, 1.5, 100));
  EXPECT_FALSE(FitPoint(std::vector<PixelOfCamera>{{first, {30, 40}}}, kFocal, 0.3, 1.5, 100));
}

TEST(EpipolarDistance2, OfAStepAsideIsSharedByBothPictures) {
  // The camera steps along x: both epipolar lines are rows, and each picture's point goes half of the way to meet.
  const Eigen::Matrix3d F = 7 * Skew(Vector3d::UnitX());
  EXPECT_NEAR(EpipolarDistance2(F, {0.3, 0.2}, {-0.4, 0.2}), 0, 1e-30);
  EXPECT_NEAR(EpipolarDistance2(F, {0.3, 0.2}, {-0.4, 0.26}), 0.06 * 0.06 / 2, 1e-12);
}

}  // namespace
}  // namespace bodyloom::projected_point_test
