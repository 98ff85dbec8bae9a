// SPDX-License-Identifier: Apache-2.0
// Derivatives of images against automatic ones of the twin, which are checked against differences.
#include "render/splat/splat_gradient.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/render/splat/same_bytes.h"
#include "tests/render/splat/splat_scene.h"

namespace bodyloom::splat_gradient_test {
namespace {

using Screen = ScreenGaussians;
using Jet = ceres::Jet<double, Screen::kNumGradients>;

/// d loss / d pixel: the loss is the sum of the planes times these.
FloatColumns PixelWeights(const PixelBox& window, uint32_t seed) {
  FloatColumns weights(SplatImage::kNumPlanes, static_cast<int>(window.area()));
  std::mt19937 generator(seed);
  for (int p = 0; p < weights.columns(); ++p) {
    for (float& w : weights.values(p)) w = static_cast<float>(generator() / 2147483648.0 - 1);
  }
  return weights;
}

template <class T>
T Loss(const std::vector<TwinSplat<T>>& splats, const PixelBox& window, double stop, const FloatColumns& weights) {
  const auto image = TwinDraw(splats, window, stop);
  T sum(0);
  for (int p = 0; p < 4; ++p) {
    for (int i = 0; i < weights.rows(); ++i) sum += T(weights(i, p)) * image.planes[p][i];
  }
  return sum;
}

FloatColumns Gradient(const Screen& screen, const PixelBox& window, float stop, const FloatColumns& weights,
                      int threads = 1) {
  SplatImage image;
  image.Draw(screen, window, {.stop_transmittance = stop, .num_threads = threads});
  SplatGradient gradient;
  FloatColumns by;
  gradient.Compute(image, screen, weights, threads, &by);
  return by;
}

/// Weights without the pixels where rounding decides whether a Gaussian is taken.
FloatColumns SureWeights(const Screen& screen, const PixelBox& window, double stop, int* left_out) {
  FloatColumns weights = PixelWeights(window, 5);
  const auto twin = TwinDraw(TwinsOf<double>(screen), window, stop, 2e-3);
  for (int i = 0; i < weights.rows(); ++i) {
    if (!twin.marginal[i]) continue;
    ++*left_out;
    for (int p = 0; p < 4; ++p) weights(i, p) = 0;
  }
  return weights;
}

TEST(SplatGradient, IsThatOfTheTwin) {
  const PixelBox window{10, 5, 70, 62};
  int compared = 0, left_out = 0;
  for (const float stop : {0.0F, 0.02F}) {
    Screen screen = SeenCloud(40, 31, 0.25, 0.08);
    screen.columns(3, Screen::kOpacity) = 1;  // at the limit of 0.99 in its middle
    screen.columns(3, Screen::kLog2Opacity) = 0;
    const FloatColumns weights = SureWeights(screen, window, stop, &left_out);
    const FloatColumns by = Gradient(screen, window, stop, weights);
    const std::vector<TwinSplat<double>> twins = TwinsOf<double>(screen);
    ASSERT_EQ(twins.size(), static_cast<size_t>(screen.size()));
    for (int i = 0; i < screen.size(); ++i) {
      std::vector<TwinSplat<Jet>> jets = TwinsOf<Jet>(screen);
      std::array<Jet, Screen::kNumGradients> row;
      const auto values = RowOf<double, Screen::kNumGradients>(screen.columns, i);
      for (int c = 0; c < Screen::kNumGradients; ++c) row[c] = Jet(values[c], c);
      jets[i] = TwinSplatOf(row, twins[i].depth);
      const Jet automatic = Loss(jets, window, stop, weights);
      const double groups[4] = {automatic.v.head<2>().cwiseAbs().maxCoeff(),
                                automatic.v.segment<3>(2).cwiseAbs().maxCoeff(), std::abs(automatic.v[5]) + 0.1,
                                automatic.v.tail<3>().cwiseAbs().maxCoeff()};
      for (int c = 0; c < Screen::kNumGradients; ++c) {
        const double scale = groups[c < 2 ? 0 : c < 5 ? 1 : c < 6 ? 2 : 3];
        EXPECT_NEAR(by(i, c), automatic.v[c], 2e-4 * scale) << "stop " << stop << ", row " << i << ", column " << c;
        if (i % 4 == 3) {
          const double step = c < 2 ? 1e-5 : c < 5 ? 1e-7 : 1e-6;
          auto above = twins, below = twins;
          auto moved = values;
          moved[c] += step;
          above[i] = TwinSplatOf(moved, twins[i].depth);
          moved[c] -= 2 * step;
          below[i] = TwinSplatOf(moved, twins[i].depth);
          const double difference =
              (Loss(above, window, stop, weights) - Loss(below, window, stop, weights)) / (2 * step);
          EXPECT_NEAR(automatic.v[c], difference, 2e-6 * scale + 1e-7) << i << ", " << c;
        }
        compared += static_cast<int>(std::abs(automatic.v[c]) > 0.01 * scale);
      }
    }
  }
  EXPECT_GT(compared, 600);
  EXPECT_LT(left_out, 2 * 60 * 57 / 3);
}

TEST(SplatGradient, OfOneGaussianInClosedForm) {
  // The loss is one pixel's alpha: α = o exp(−½ q).
  const Screen screen = ScreenOf({{8.5F, 7.25F, 4, 0.5F, 1, 1, 1, 2}});
  const PixelBox window{0, 0, 16, 16};
  FloatColumns weights(SplatImage::kNumPlanes, 256);
  weights(static_cast<int>(window.IndexOf(10, 8)), SplatImage::kAlpha) = 1;
  const FloatColumns by = Gradient(screen, window, 0, weights);
  const double dx = 1.5, dy = 0.75, alpha = 0.5 * std::exp(-0.5 * (dx * dx + dy * dy) / 4);
  EXPECT_NEAR(by(0, Screen::kMeanX), alpha * dx / 4, 1e-6);
  EXPECT_NEAR(by(0, Screen::kMeanY), alpha * dy / 4, 1e-6);
  EXPECT_NEAR(by(0, Screen::kConicXx), -0.5 * alpha * dx * dx, 1e-6);
  EXPECT_NEAR(by(0, Screen::kConicXy), -alpha * dx * dy, 1e-6);
  EXPECT_NEAR(by(0, Screen::kConicYy), -0.5 * alpha * dy * dy, 1e-6);
  EXPECT_NEAR(by(0, Screen::kOpacity), alpha / 0.5, 1e-6);
  for (const int c : {Screen::kRed, Screen::kGreen, Screen::kBlue}) EXPECT_EQ(by(0, c), 0);
}

TEST(SplatGradient, AtTheLimitOnlyColourMoves) {
  const Screen screen = ScreenOf({{8, 8, 4, 1, 1, 1, 1, 2}});
  const PixelBox window{0, 0, 16, 16};
  FloatColumns weights(SplatImage::kNumPlanes, 256);
  weights(static_cast<int>(window.IndexOf(8, 8)), SplatImage::kRed) = 1;
  const FloatColumns by = Gradient(screen, window, 0, weights);
  for (int c = 0; c < Screen::kRed; ++c) EXPECT_EQ(by(0, c), 0) << c;
  EXPECT_NEAR(by(0, Screen::kRed), 0.99, 1e-6);
}

TEST(SplatGradient, ZeroForWhatIsNotSeen) {
  // Behind a finished pixel, outside the window, and not drawn at all.
  Screen screen = ScreenOf({{8, 8, 900, 1, 1, 1, 1, 1},
                            {8, 8, 900, 1, 1, 1, 1, 2},
                            {8, 8, 1, 0.5F, 1, 1, 1, 3},
                            {200, 8, 1, 0.5F, 1, 1, 1, 1},
                            {8, 8, 1, 0.5F, 1, 1, 1, 0.5F}});
  screen.columns(4, Screen::kHalfWidth) = screen.columns(4, Screen::kHalfHeight) = -1;
  const PixelBox window{0, 0, 16, 16};
  const FloatColumns by = Gradient(screen, window, 0.005F, PixelWeights(window, 2));
  for (const int row : {2, 3, 4}) {
    for (int c = 0; c < Screen::kNumGradients; ++c) EXPECT_EQ(by(row, c), 0) << row << ", " << c;
  }
  EXPECT_NE(by(1, Screen::kRed), 0);
}

TEST(SplatGradient, SameBytesEverywhere) {
  const Screen screen = SeenCloud(9000, 7, 0.6, 0.03);
  const PixelBox window{-5, -7, 101, 90};
  const FloatColumns weights = PixelWeights(window, 8);
  ExpectSameBytesEverywhere(
      [&](int threads, FloatColumns* out) { *out = Gradient(screen, window, 1.0F / 512, weights, threads); });
}

TEST(SplatGradient, ThePixelsOfAWindowAddUp) {
  // The loss over a picture is that over its two halves.
  const Screen screen = SeenCloud(300, 12);
  const PixelBox whole{0, 0, 96, 80}, left{0, 0, 41, 80}, right{41, 0, 96, 80};
  const FloatColumns weights = PixelWeights(whole, 3);
  const auto part = [&](const PixelBox& window) {
    FloatColumns cut(SplatImage::kNumPlanes, static_cast<int>(window.area()));
    for (int y = window.y_begin; y < window.y_end; ++y) {
      for (int x = window.x_begin; x < window.x_end; ++x) {
        for (int p = 0; p < 4; ++p) {
          cut(static_cast<int>(window.IndexOf(x, y)), p) = weights(static_cast<int>(whole.IndexOf(x, y)), p);
        }
      }
    }
    return Gradient(screen, window, 0.01F, cut);
  };
  const FloatColumns all = Gradient(screen, whole, 0.01F, weights), a = part(left), b = part(right);
  for (int c = 0; c < Screen::kNumGradients; ++c) {
    double largest = 0;
    for (int i = 0; i < screen.size(); ++i) largest = std::max(largest, std::abs(double(all(i, c))));
    for (int i = 0; i < screen.size(); ++i) EXPECT_NEAR(all(i, c), a(i, c) + b(i, c), 2e-6 * largest) << i << ", " << c;
  }
}

TEST(SplatGradient, RefusesTablesOfOtherSizes) {
  const Screen screen = SeenCloud(10, 1);
  SplatImage image;
  image.Draw(screen, {0, 0, 20, 20});
  SplatGradient gradient;
  FloatColumns by;
  EXPECT_THROW(gradient.Compute(image, screen, FloatColumns(4, 399), 1, &by), std::invalid_argument);
  EXPECT_THROW(gradient.Compute(image, screen, FloatColumns(3, 400), 1, &by), std::invalid_argument);
  EXPECT_THROW(gradient.Compute(image, SeenCloud(9, 1), FloatColumns(4, 400), 1, &by), std::invalid_argument);
  EXPECT_THROW(gradient.Compute(image, screen, FloatColumns(4, 400), 0, &by), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::splat_gradient_test
