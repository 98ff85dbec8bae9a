// SPDX-License-Identifier: Apache-2.0
// Projection against its twin and closed forms, its derivatives against automatic ones and differences, and the
// Gaussians that are not drawn.
#include "render/splat/project_gaussians.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/render/splat/same_bytes.h"
#include "tests/support/splat_twin.h"

namespace bodyloom::project_gaussians_test {
namespace {

using In = CameraGaussians;
using Out = ScreenGaussians;
using Jet = ceres::Jet<double, In::kNumColumns>;

Camera PinholeCamera() {
  Camera camera = MakePinhole(96, 80, 150);
  camera.fy = 140, camera.cx = 50.5, camera.cy = 37;
  return camera;
}

Camera WeakCamera() {
  Camera camera;
  camera.model = CameraModel::kWeakPerspective;
  camera.width = 96, camera.height = 80;
  camera.scale = 60, camera.tx = 0.1, camera.ty = -0.2, camera.cx = 48, camera.cy = 40;
  return camera;
}

CameraGaussians OneBall(double z, double sigma, float opacity = 0.8F) {
  CameraGaussians ball;
  ball.Resize(1);
  ball.columns.Fill(0);
  ball.columns(0, In::kZ) = static_cast<float>(z);
  for (int k = 0; k < 3; ++k) ball.columns(0, In::kFactor + 4 * k) = static_cast<float>(sigma);
  ball.columns(0, In::kOpacity) = opacity;
  for (int k = 0; k < 3; ++k) ball.columns(0, In::kRed + k) = 0.25F * static_cast<float>(k + 1);
  return ball;
}

bool Draws(const CameraGaussians& gaussians, const ProjectGaussiansOptions& options = {},
           const Camera& camera = PinholeCamera()) {
  ScreenGaussians screen;
  ProjectGaussians(gaussians, camera, options, &screen);
  for (int c = 0; c < Out::kNumColumns; ++c) EXPECT_TRUE(std::isfinite(screen.columns(0, c))) << c;
  if (!screen.IsDrawn(0)) {
    for (int c = 0; c < Out::kHalfWidth; ++c) EXPECT_EQ(screen.columns(0, c), 0) << c;
    EXPECT_EQ(screen.columns(0, Out::kHalfWidth), -1);
    EXPECT_EQ(screen.columns(0, Out::kHalfHeight), -1);
  }
  return screen.IsDrawn(0);
}

TEST(ProjectGaussians, ABallOnTheAxisIsADisc) {
  ScreenGaussians screen;
  ProjectGaussians(OneBall(2, 0.04), PinholeCamera(), {}, &screen);
  const double across = 150 * 0.04 / 2, down = 140 * 0.04 / 2;
  const FloatColumns& c = screen.columns;
  EXPECT_NEAR(c(0, Out::kMeanX), 50.5, 1e-5);
  EXPECT_NEAR(c(0, Out::kMeanY), 37, 1e-5);
  EXPECT_NEAR(c(0, Out::kConicXx), 1 / (across * across + 0.2), 1e-7);
  EXPECT_NEAR(c(0, Out::kConicYy), 1 / (down * down + 0.2), 1e-7);
  EXPECT_EQ(c(0, Out::kConicXy), 0);
  EXPECT_EQ(c(0, Out::kDepth), 2);
  EXPECT_NEAR(c(0, Out::kLog2Opacity), std::log2(0.8), 1e-6);
  const double reach = std::sqrt(2 * std::log(255 * 0.8) * (across * across + 0.2));
  EXPECT_GE(c(0, Out::kHalfWidth), reach);
  EXPECT_LT(c(0, Out::kHalfWidth), reach * 1.0002 + 0.011);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(c(0, Out::kRed + k), 0.25F * static_cast<float>(k + 1));
}

TEST(ProjectGaussians, IsItsTwin) {
  for (const Camera& camera : {PinholeCamera(), WeakCamera()}) {
    for (const float low_pass : {0.2F, 0.0F, 3.0F}) {
      const CameraGaussians cloud = GaussianCloud(300, 5);
      ScreenGaussians screen;
      ProjectGaussians(cloud, camera, {.low_pass_px2 = low_pass}, &screen);
      int drawn = 0;
      for (int i = 0; i < cloud.size(); ++i) {
        if (!screen.IsDrawn(i)) continue;
        ++drawn;
        const TwinSplat<double> twin =
            TwinProject(TwinGaussianOf(RowOf<double, In::kNumColumns>(cloud.columns, i)), camera, low_pass);
        const FloatColumns& c = screen.columns;
        for (int k = 0; k < 2; ++k) EXPECT_NEAR(c(i, Out::kMeanX + k), twin.mean[k], 2e-5) << i;
        const double maximum = std::max(twin.conic[0], twin.conic[2]);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(c(i, Out::kConicXx + k), twin.conic[k], 2e-5 * maximum) << i;
        EXPECT_NEAR(c(i, Out::kLog2Opacity), std::log2(twin.opacity), 1e-6);
      }
      EXPECT_GE(drawn, 290);
    }
  }
}

/// Random weights of the nine numbers of each row: the loss is their sum.
FloatColumns Weights(int rows) {
  FloatColumns weights(Out::kNumGradients, rows);
  std::mt19937 generator(11);
  for (int c = 0; c < weights.columns(); ++c) {
    for (float& w : weights.values(c)) w = static_cast<float>(generator() / 2147483648.0 - 1);
  }
  return weights;
}

template <class T>
T WeightedSum(const std::array<T, In::kNumColumns>& row, const Camera& camera, const FloatColumns& weights, int i) {
  const TwinSplat<T> s = TwinProject(TwinGaussianOf(row), camera, 0.2);
  const T values[Out::kNumGradients] = {s.mean[0], s.mean[1],   s.conic[0],  s.conic[1], s.conic[2],
                                        s.opacity, s.colour[0], s.colour[1], s.colour[2]};
  T sum(0);
  for (int c = 0; c < Out::kNumGradients; ++c) sum += T(weights(i, c)) * values[c];
  return sum;
}

TEST(ProjectGaussians, DerivativesAreAutomaticOnesAndDifferences) {
  int compared = 0;
  for (const Camera& camera : {PinholeCamera(), WeakCamera()}) {
    const CameraGaussians cloud = GaussianCloud(60, 8);
    const FloatColumns weights = Weights(cloud.size());
    ScreenGaussians screen;
    ProjectGaussians(cloud, camera, {}, &screen);
    FloatColumns by;
    ProjectGaussiansBackward(cloud, screen, weights, camera, {}, &by);
    ASSERT_EQ(by.rows(), cloud.size());
    for (int i = 0; i < cloud.size(); ++i) {
      ASSERT_TRUE(screen.IsDrawn(i));
      std::array<Jet, In::kNumColumns> row;
      const auto values = RowOf<double, In::kNumColumns>(cloud.columns, i);
      for (int c = 0; c < In::kNumColumns; ++c) row[c] = Jet(values[c], c);
      const Jet automatic = WeightedSum(row, camera, weights, i);
      const double largest_factor = automatic.v.segment<9>(In::kFactor).cwiseAbs().maxCoeff();
      const double largest_place = automatic.v.head<3>().cwiseAbs().maxCoeff();
      for (int c = 0; c < In::kNumColumns; ++c) {
        auto above = values, below = values;
        const double step = 1e-6;
        above[c] += step, below[c] -= step;
        const double difference =
            (WeightedSum(above, camera, weights, i) - WeightedSum(below, camera, weights, i)) / (2 * step);
        const double scale = c < 3 ? largest_place : c < In::kFactor + 9 ? largest_factor : 1;
        EXPECT_NEAR(automatic.v[c], difference, 1e-6 * scale) << i << ", " << c;
        EXPECT_NEAR(by(i, c), automatic.v[c], 3e-5 * scale) << i << ", " << c;
        compared += static_cast<int>(std::abs(difference) > 1e-3 * scale);
      }
    }
  }
  EXPECT_GT(compared, 1200);
}

TEST(ProjectGaussians, WhatIsNotDrawn) {
  EXPECT_TRUE(Draws(OneBall(2, 0.04)));
  for (int c = 0; c < In::kNumColumns; ++c) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), INFINITY, -INFINITY}) {
      CameraGaussians ball = OneBall(2, 0.04);
      ball.columns(0, c) = bad;
      EXPECT_FALSE(Draws(ball)) << c;
    }
  }
  EXPECT_FALSE(Draws(OneBall(-2, 0.04)));
  EXPECT_FALSE(Draws(OneBall(0, 0.04)));
  EXPECT_FALSE(Draws(OneBall(0.0999, 1e-4)));
  EXPECT_TRUE(Draws(OneBall(0.1001, 1e-4)));
  EXPECT_TRUE(Draws(OneBall(-2, 0.04), {}, WeakCamera()));
  EXPECT_FALSE(Draws(OneBall(2, 0.04, 0.0039F)));
  EXPECT_TRUE(Draws(OneBall(2, 0.04, 0.00393F)));
  EXPECT_TRUE(Draws(OneBall(2, 0.04, 1.0F)));
  EXPECT_FALSE(Draws(OneBall(2, 0.04, 1.0001F)));
  EXPECT_FALSE(Draws(OneBall(2, 0.04, -1.0F)));
  EXPECT_FALSE(Draws(OneBall(2, 20)));  // reaches 5,000 px
  EXPECT_TRUE(Draws(OneBall(2, 10)));
  EXPECT_TRUE(Draws(OneBall(2, 0)));  // a dot
  EXPECT_FALSE(Draws(OneBall(2, 0), {.low_pass_px2 = 0}));
  CameraGaussians needle = OneBall(2, 0.04);
  needle.columns(0, In::kFactor) = 0;
  EXPECT_TRUE(Draws(needle));
  EXPECT_FALSE(Draws(needle, {.low_pass_px2 = 0}));
  CameraGaussians far = OneBall(2, 0.04);
  far.columns(0, In::kX) = 1e5F;
  EXPECT_FALSE(Draws(far));
  CameraGaussians glaring = OneBall(2, 0.04);
  glaring.columns(0, In::kGreen) = -1.1e6F;
  EXPECT_FALSE(Draws(glaring));
}

TEST(ProjectGaussians, NoDerivativeReachesWhatIsNotDrawn) {
  CameraGaussians cloud = GaussianCloud(40, 2);
  for (int i = 0; i < cloud.size(); i += 3) {
    cloud.columns(i, i % 2 == 0 ? In::kX : In::kZ) = std::numeric_limits<float>::quiet_NaN();
  }
  ScreenGaussians screen;
  ProjectGaussians(cloud, PinholeCamera(), {}, &screen);
  FloatColumns by;
  ProjectGaussiansBackward(cloud, screen, Weights(cloud.size()), PinholeCamera(), {}, &by);
  for (int i = 0; i < cloud.size(); ++i) {
    EXPECT_EQ(screen.IsDrawn(i), i % 3 != 0);
    for (int c = 0; c < In::kNumColumns; ++c) {
      EXPECT_TRUE(std::isfinite(by(i, c)));
      if (i % 3 == 0) {
        EXPECT_EQ(by(i, c), 0);
      }
    }
  }
}

TEST(ProjectGaussians, SameBytesEverywhere) {
  const CameraGaussians cloud = GaussianCloud(3001, 21);
  ScreenGaussians screen;
  ExpectSameBytesEverywhere([&](int threads, FloatColumns* out) {
    ProjectGaussians(cloud, PinholeCamera(), {.num_threads = threads}, &screen);
    *out = FloatColumns(Out::kNumColumns, cloud.size());
    for (int c = 0; c < Out::kNumColumns; ++c) std::copy_n(screen.columns.column(c), cloud.size(), out->column(c));
  });
  const FloatColumns weights = Weights(cloud.size());
  ExpectSameBytesEverywhere([&](int threads, FloatColumns* out) {
    ProjectGaussiansBackward(cloud, screen, weights, PinholeCamera(), {.num_threads = threads}, out);
  });
}

TEST(ProjectGaussians, RefusesWhatItCannotDo) {
  const CameraGaussians ball = OneBall(2, 0.04);
  ScreenGaussians screen;
  Camera bent = PinholeCamera();
  bent.distortion[0] = 0.1;
  EXPECT_THROW(ProjectGaussians(ball, bent, {}, &screen), std::invalid_argument);
  Camera broken = PinholeCamera();
  broken.fx = NAN;
  EXPECT_THROW(ProjectGaussians(ball, broken, {}, &screen), std::invalid_argument);
  EXPECT_THROW(ProjectGaussians(ball, PinholeCamera(), {.low_pass_px2 = -1}, &screen), std::invalid_argument);
  EXPECT_THROW(ProjectGaussians(ball, PinholeCamera(), {.near_m = 0}, &screen), std::invalid_argument);
  EXPECT_THROW(ProjectGaussians(ball, PinholeCamera(), {.num_threads = 0}, &screen), std::invalid_argument);
  ProjectGaussians(ball, PinholeCamera(), {}, &screen);
  FloatColumns by;
  EXPECT_THROW(ProjectGaussiansBackward(ball, screen, FloatColumns(Out::kNumGradients, 2), PinholeCamera(), {}, &by),
               std::invalid_argument);
}

TEST(ProjectGaussians, OfNothing) {
  CameraGaussians none;
  none.Resize(0);
  ScreenGaussians screen;
  ProjectGaussians(none, PinholeCamera(), {}, &screen);
  EXPECT_EQ(screen.size(), 0);
}

}  // namespace
}  // namespace bodyloom::project_gaussians_test
