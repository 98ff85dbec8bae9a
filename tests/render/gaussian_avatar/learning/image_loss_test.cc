// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/learning/image_loss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/render/splat/same_bytes.h"

namespace bodyloom::image_loss_test {
namespace {

FloatColumns RandomPlanes(int width, int height, uint32_t seed) {
  std::mt19937 generator(seed);
  FloatColumns planes(4, width * height);
  for (int i = 0; i < planes.rows(); ++i) {
    planes(i, 3) = static_cast<float>(generator() / 4294967296.0);
    for (int c = 0; c < 3; ++c) planes(i, c) = planes(i, 3) * static_cast<float>(generator() / 4294967296.0);
  }
  return planes;
}

ImageTruth RandomTruth(int width, int height) {
  ImageTruth truth;
  truth.width = width, truth.height = height, truth.person_pixels = 0.4 * width * height;
  truth.planes = RandomPlanes(width, height, 7);
  return truth;
}

constexpr std::array<float, 3> kBehind = {0.2F, 0.9F, 0.5F};

/// The header's formula, window by window, in double.
double TwinLoss(const FloatColumns& image, const ImageTruth& truth, const std::array<float, 3>& behind) {
  constexpr int kRadius = 5;
  double weights[2 * kRadius + 1], total = 0, loss = 0;
  for (int t = -kRadius; t <= kRadius; ++t) total += weights[t + kRadius] = std::exp(-t * t / 4.5);
  for (double& w : weights) w /= total;
  for (int c = 0; c < 3; ++c) {
    const auto at = [&](const FloatColumns& planes, int x, int y) {
      if (x < 0 || y < 0 || x >= truth.width || y >= truth.height) return 0.0;
      const int i = y * truth.width + x;
      return planes(i, c) + (1 - static_cast<double>(planes(i, 3))) * behind[c];
    };
    for (int y = 0; y < truth.height; ++y) {
      for (int x = 0; x < truth.width; ++x) {
        double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
        for (int v = -kRadius; v <= kRadius; ++v) {
          for (int u = -kRadius; u <= kRadius; ++u) {
            const double w = weights[u + kRadius] * weights[v + kRadius];
            const double p = at(image, x + u, y + v), q = at(truth.planes, x + u, y + v);
            a += w * p, b += w * q, aa += w * p * p, bb += w * q * q, ab += w * p * q;
          }
        }
        const double ssim = (2 * a * b + 1e-4) * (2 * (ab - a * b) + 9e-4) /
                            ((a * a + b * b + 1e-4) * (aa - a * a + bb - b * b + 9e-4));
        loss += 0.2 * (1 - ssim) + 0.8 * std::abs(at(image, x, y) - at(truth.planes, x, y));
      }
    }
  }
  return loss / (3 * 1.3 * truth.person_pixels);
}

TEST(ImageLoss, IsTheFormulaWrittenOutPlainly) {
  for (const auto& [width, height] : {std::pair(37, 23), std::pair(16, 16), std::pair(3, 2), std::pair(1, 40)}) {
    const ImageTruth truth = RandomTruth(width, height);
    const FloatColumns image = RandomPlanes(width, height, 3);
    FloatColumns by_planes;
    const double loss = ImageLoss().Compute(image, truth, kBehind, 1, &by_planes);
    EXPECT_NEAR(loss, TwinLoss(image, truth, kBehind), 2e-6 * loss) << width << "x" << height;
  }
}

TEST(ImageLoss, DerivativesAreThoseOfTheTwin) {
  const ImageTruth truth = RandomTruth(21, 18);
  FloatColumns image = RandomPlanes(21, 18, 3), by_planes;
  ImageLoss().Compute(image, truth, kBehind, 1, &by_planes);
  double scale = 0;
  for (int c = 0; c < 4; ++c) {
    for (const float by : by_planes.values(c)) scale = std::max<double>(scale, std::abs(by));
  }
  int compared = 0;
  for (int i = 0; i < image.rows(); i += 5) {
    for (int c = 0; c < 4; ++c) {
      const float before = image(i, c);
      image(i, c) = before + 1e-4F;
      const double after = image(i, c), more = TwinLoss(image, truth, kBehind);
      image(i, c) = before - 1e-4F;
      const double difference = (more - TwinLoss(image, truth, kBehind)) / (after - image(i, c));
      image(i, c) = before;
      EXPECT_NEAR(by_planes(i, c), difference, 2e-3 * scale) << "pixel " << i << ", plane " << c;
      ++compared;
    }
  }
  EXPECT_GE(compared, 300);
}

TEST(ImageLoss, IsZeroWithoutDerivativesForTheTruth) {
  const ImageTruth truth = RandomTruth(40, 30);
  FloatColumns by_planes;
  EXPECT_EQ(ImageLoss().Compute(truth.planes, truth, kBehind, 2, &by_planes), 0);
  for (int c = 0; c < 4; ++c) {
    for (const float by : by_planes.values(c)) EXPECT_NEAR(by, 0, 1e-6);
  }
}

TEST(ImageLoss, ByPixelIsWhatAnAbsoluteDifferenceGives) {
  // Of two evenly grey pictures SSIM knows the means alone: far from 0 its derivative is small beside the other.
  ImageTruth truth;
  truth.width = truth.height = 40, truth.person_pixels = 900;
  truth.planes.Resize(4, 1600);
  FloatColumns image(4, 1600), by_planes;
  for (int c = 0; c < 4; ++c) {
    std::fill_n(truth.planes.column(c), 1600, c < 3 ? 0.6F : 1.0F);
    std::fill_n(image.column(c), 1600, c < 3 ? 0.62F : 1.0F);
  }
  ImageLoss().Compute(image, truth, kBehind, 1, &by_planes);
  EXPECT_NEAR(by_planes(20 * 40 + 20, 1) / ImageLoss::ByPixel(truth), 1, 0.1);
}

TEST(ImageLoss, SeesAHoleOverAColourAlone) {
  // A hole where a black person should be is no error over black.
  ImageTruth truth;
  truth.width = truth.height = 20, truth.person_pixels = 400;
  truth.planes.Resize(4, 400);
  truth.planes.Fill(0);
  std::fill_n(truth.planes.column(3), 400, 1.0F);
  FloatColumns hole(4, 400), by_planes;
  hole.Fill(0);
  ImageLoss loss;
  EXPECT_EQ(loss.Compute(hole, truth, {0, 0, 0}, 1, &by_planes), 0);
  EXPECT_GT(loss.Compute(hole, truth, {0, 1, 0}, 1, &by_planes), 0.2);
}

TEST(ImageLoss, SameBytesForAnyThreadsAndInstructionSet) {
  const ImageTruth truth = RandomTruth(101, 77);
  const FloatColumns image = RandomPlanes(101, 77, 3);
  ImageLoss loss;
  ExpectSameBytesEverywhere([&](int threads, FloatColumns* table) {
    const double value = loss.Compute(image, truth, kBehind, threads, table);
    EXPECT_EQ(value, ImageLoss().Compute(image, truth, kBehind, 1, table));
  });
}

TEST(ImageLoss, RefusesTablesOfOtherSizes) {
  FloatColumns by_planes;
  ImageTruth truth = RandomTruth(4, 4);
  EXPECT_THROW(ImageLoss().Compute(RandomPlanes(4, 5, 1), truth, kBehind, 1, &by_planes), std::invalid_argument);
  truth.person_pixels = 0;
  EXPECT_THROW(ImageLoss().Compute(RandomPlanes(4, 4, 1), truth, kBehind, 1, &by_planes), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::image_loss_test
