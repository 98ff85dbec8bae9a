// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace bodyloom::camera_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::vector<Camera> Cameras() {
  const std::vector<std::array<double, 8>> lenses = {
      {},
      {-0.08, 0.03, 0, 0, 0, 0, 0, 0},
      {0.12, -0.05, 0.002, -0.001, 0.01, 0, 0, 0},
      {-0.28, 0.09, 0.0005, 0.0003, -0.012, 0, 0, 0},    // action camera
      {8.1, 4.3, 0.0008, -0.0002, 0.19, 8.4, 6.9, 1.2},  // rational model, large cancelling terms
      {0, 0, 0.01, -0.02, 0, 0, 0, 0},                   // tangential alone
  };
  std::vector<Camera> cameras;
  for (const auto& lens : lenses) {
    Camera camera = MakePinhole(1920, 1080, 1300);
    camera.fy = 1290;
    camera.cx = 951.5;
    camera.distortion = lens;
    cameras.push_back(camera);
  }
  Camera weak;
  weak.model = CameraModel::kWeakPerspective;
  weak.scale = 230;
  weak.tx = 0.1;
  weak.ty = -0.3;
  weak.cx = 255.5;
  weak.cy = 250;
  cameras.push_back(weak);
  return cameras;
}

Vector3d RandomPoint(std::mt19937* random) {
  std::uniform_real_distribution<double> x(-0.6, 0.6), y(-0.4, 0.4), depth(0.5, 12);
  const double z = depth(*random);
  return {z * x(*random), z * y(*random), z};
}

TEST(Camera, PinholeAgreesWithOpenCv) {
  std::mt19937 random(1);
  int checked = 0;
  for (const Camera& camera : Cameras()) {
    if (camera.model != CameraModel::kPinhole) continue;
    std::vector<cv::Point3d> points;
    std::vector<Vector2d> own;
    for (int i = 0; i < 300; ++i) {
      const Vector3d X = RandomPoint(&random);
      Vector2d pixel;
      if (!camera.Project(X, &pixel)) continue;
      points.emplace_back(X.x(), X.y(), X.z());
      own.push_back(pixel);
    }
    ASSERT_GT(points.size(), 280u);
    const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    const std::vector<double> lens(camera.distortion.begin(), camera.distortion.end());
    std::vector<cv::Point2d> expected;
    cv::projectPoints(points, cv::Vec3d(0, 0, 0), cv::Vec3d(0, 0, 0), K, lens, expected);
    for (size_t i = 0; i < own.size(); ++i) {
      EXPECT_NEAR(own[i].x(), expected[i].x, 1e-10);
      EXPECT_NEAR(own[i].y(), expected[i].y, 1e-10);
      ++checked;
    }
  }
  EXPECT_GT(checked, 6 * 280);
}

TEST(Camera, JacobianAgreesWithCentralDifferences) {
  std::mt19937 random(2);
  int checked = 0;
  for (const Camera& camera : Cameras()) {
    for (int i = 0; i < 100; ++i) {
      const Vector3d X = RandomPoint(&random);
      Vector2d pixel, plain;
      Matrix2x3d J;
      if (!camera.Project(X, &pixel, &J)) continue;
      ASSERT_TRUE(camera.Project(X, &plain));
      EXPECT_EQ(pixel, plain);
      const double step = 1e-6 * X.z();
      for (int k = 0; k < 3; ++k) {
        Vector2d plus, minus;
        ASSERT_TRUE(camera.Project(X + step * Vector3d::Unit(k), &plus));
        ASSERT_TRUE(camera.Project(X - step * Vector3d::Unit(k), &minus));
        EXPECT_LT(((plus - minus) / (2 * step) - J.col(k)).norm(), 1e-8 * (J.norm() + 1)) << k;
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 7 * 90 * 3);
}

TEST(Camera, UnprojectInvertsProject) {
  std::mt19937 random(3);
  int checked = 0;
  for (const Camera& camera : Cameras()) {
    for (int i = 0; i < 200; ++i) {
      const Vector3d X = RandomPoint(&random);
      Vector2d pixel;
      if (!camera.Project(X, &pixel)) continue;
      const Vector2d ray = camera.Unproject(pixel);
      if (camera.model == CameraModel::kPinhole) {
        EXPECT_LT((ray - Vector2d(X.x(), X.y()) / X.z()).norm(), 1e-12);
      } else {
        EXPECT_LT((ray - X.head<2>()).norm(), 1e-12);
      }
      ++checked;
    }
  }
  EXPECT_GT(checked, 7 * 190);
}

TEST(Camera, UnprojectWorksUpToTheEdgeOfTheFieldOfView) {
  Camera camera = MakePinhole(1000, 1000, 500);
  camera.distortion[0] = -0.3;
  const double edge = std::sqrt(1 / (3 * 0.3));  // 1 + 3 k1 r² = 0
  for (double fraction : {0.5, 0.9, 0.99, 0.999}) {
    const double r = fraction * edge;
    Vector2d pixel;
    ASSERT_TRUE(camera.Project({r, 0, 1}, &pixel));
    EXPECT_NEAR(camera.Unproject(pixel).x(), r, 1e-9) << fraction;
  }
  const double largest_px = 500 * edge * (1 - 0.3 * edge * edge) + camera.cx;
  EXPECT_FALSE(std::isnan(camera.Unproject({largest_px - 0.5, camera.cy}).x()));
  EXPECT_TRUE(std::isnan(camera.Unproject({largest_px + 0.5, camera.cy}).x()));
}

TEST(Camera, FoldedBackPointsAreInvalidAtAndBeyondTheFold) {
  // 1 + 3 k1 s + 5 k2 s² < 0 between two radii and positive again beyond the second.
  Camera camera = MakePinhole(1000, 1000, 500);
  camera.distortion = {-0.6, 0.15, 0, 0, 0, 0, 0, 0};
  const double root = std::sqrt(1.8 * 1.8 - 4 * 0.75), low = std::sqrt((1.8 - root) / 1.5),
               high = std::sqrt((1.8 + root) / 1.5);
  ASSERT_LT(low, high);
  Vector2d pixel;
  Matrix2x3d J;
  int valid = 0, invalid = 0;
  for (double r = 0.01; r < 4; r += 0.01) {
    for (double phi : {0.0, 1.0, 4.0}) {
      pixel.setConstant(7);
      J.setConstant(7);
      const bool ok = camera.Project({3 * r * std::cos(phi), 3 * r * std::sin(phi), 3}, &pixel, &J);
      EXPECT_EQ(ok, r < low) << r << " fold at " << low << " rises again at " << high;
      EXPECT_TRUE(ok || (pixel.isZero(0) && J.isZero(0)));
      (ok ? valid : invalid)++;
    }
  }
  EXPECT_GT(valid, 100);
  EXPECT_GT(invalid, 100);
}

TEST(Camera, AVanishingDenominatorIsInvalid) {
  Camera camera = MakePinhole(1000, 1000, 500);
  camera.distortion = {0, 0, 0, 0, 0, -0.5, 0, 0};  // 1 − r²/2
  Vector2d pixel;
  EXPECT_TRUE(camera.Project({1.2, 0, 1}, &pixel));
  EXPECT_FALSE(camera.Project({std::sqrt(2), 0, 1}, &pixel));
  EXPECT_FALSE(camera.Project({3, 0, 1}, &pixel));
}

TEST(Camera, BehindTheCameraAndNonFinitePointsAreInvalid) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const Camera& camera : Cameras()) {
    std::vector<Vector3d> points = {{nan, 0, 1}, {0, nan, 1}, {0, 0, nan}, {infinity, 0, 1}, {0, 0, infinity}};
    if (camera.model == CameraModel::kPinhole) {
      points.insert(points.end(), {{0.1, 0, Camera::kMinDepth}, {0, 0, 0}, {0, 0, -1}, {1e308, 0, -1e308}});
    }
    for (const Vector3d& X : points) {
      Vector2d pixel(7, 7);
      Matrix2x3d J = Matrix2x3d::Constant(7);
      EXPECT_FALSE(camera.Project(X, &pixel, &J)) << X.transpose();
      EXPECT_TRUE(pixel.isZero(0) && J.isZero(0));
    }
  }
  Camera lens = MakePinhole(100, 100, 100);
  lens.distortion[0] = -0.1;
  for (double far : {1e3, 1e10, 1e200, infinity, nan}) EXPECT_TRUE(lens.Unproject({far, 0}).hasNaN()) << far;
}

TEST(Camera, WeakPerspective) {
  Camera camera;
  camera.model = CameraModel::kWeakPerspective;
  camera.scale = 200;
  camera.tx = 0.5;
  camera.ty = -0.25;
  camera.cx = 100;
  camera.cy = 50;
  Vector2d pixel;
  Matrix2x3d J;
  ASSERT_TRUE(camera.Project({1, 2, -5}, &pixel, &J));
  EXPECT_EQ(pixel, Vector2d(200 * 1.5 + 100, 200 * 1.75 + 50));
  Matrix2x3d expected;
  expected << 200, 0, 0, 0, 200, 0;
  EXPECT_EQ(J, expected);
  EXPECT_EQ(camera.K()(0, 0), 200);
  EXPECT_EQ(camera.K()(1, 2), 50);
}

TEST(Camera, NamesAndConstruction) {
  for (CameraModel model : {CameraModel::kPinhole, CameraModel::kWeakPerspective}) {
    EXPECT_EQ(CameraModelFromString(ToString(model)), model);
  }
  try {
    CameraModelFromString("fisheye");
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("'fisheye'"), std::string::npos);
  }
  const Camera camera = MakePinhole(640, 480, 500);
  EXPECT_EQ(camera.cx, 319.5);
  EXPECT_EQ(camera.cy, 239.5);
  EXPECT_FALSE(camera.HasDistortion());
  Vector2d centre;
  ASSERT_TRUE(camera.Project({0, 0, 2}, &centre));
  EXPECT_EQ(centre, Vector2d(319.5, 239.5));
  EXPECT_EQ(camera.K()(0, 0), 500);
  EXPECT_THROW(MakePinhole(0, 480, 500), std::invalid_argument);
  EXPECT_THROW(MakePinhole(640, 480, std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::camera_test
