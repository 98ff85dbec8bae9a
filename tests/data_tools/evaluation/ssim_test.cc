// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/ssim.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "data_tools/evaluation/ssim_rows_simd.h"

namespace bodyloom::ssim_test {
namespace {

using ::testing::ElementsAre;

/// A patterned picture and a disturbed one, the same on every machine.
struct Pair {
  Image truth, result;
};
Pair MakePair(int width, int height) {
  Pair pair{Image(width, height), Image(width, height)};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {  // red, green, blue
        const int value = (x * 7 + y * 13 + x * y % 31 * 3 + c * 50) % 256;
        const int noise = (x * 31 + y * 17 + c * 7) % 41 - 20;
        pair.truth.pixel(x, y)[2 - c] = static_cast<uint8_t>(value);
        pair.result.pixel(x, y)[2 - c] = static_cast<uint8_t>(std::clamp(value + noise, 0, 255));
      }
    }
  }
  return pair;
}

PlanarImage Scaled(const Image& image, double factor) {
  PlanarImage planar = PlanarFrom(image);
  for (double& value : planar.values) value *= factor;
  return planar;
}

PlanarImage RandomPlanes(int width, int height, int channels, int seed) {
  std::mt19937 random(seed);
  PlanarImage image{width, height, channels, {}};
  for (int i = 0; i < width * height * channels; ++i) image.values.push_back(random() / 4294967296.0);
  return image;
}

/// The header's definition, window by window: two passes, two-dimensional weights, pixels outside are zero.
struct SlowSsim {
  std::vector<double> weights;  ///< side × side
  int side = 0;
  double range = 1, covariance_norm = 1;
  bool is_everywhere = false;

  static SlowSsim Uniform(int side, double range) {
    const double n = side * side;
    return {std::vector<double>(side * side, 1 / n), side, range, n / (n - 1), false};
  }
  static SlowSsim Gaussian(double range, bool is_everywhere = false) {
    std::vector<double> weights;
    double sum = 0;
    for (int y = -5; y <= 5; ++y) {
      for (int x = -5; x <= 5; ++x) sum += weights.emplace_back(std::exp(-(x * x + y * y) / (2 * 1.5 * 1.5)));
    }
    for (double& weight : weights) weight /= sum;
    return {weights, 11, range, 1, is_everywhere};
  }

  double operator()(const PlanarImage& a, const PlanarImage& b) const {
    const int before = is_everywhere ? side / 2 : 0, width = a.width - side + 1 + 2 * before,
              height = a.height - side + 1 + 2 * before;
    long double sum = 0;
    for (int c = 0; c < a.channels; ++c) {
      for (int y = -before; y < height - before; ++y) {
        for (int x = -before; x < width - before; ++x) sum += At(a, b, c, x, y);
      }
    }
    return static_cast<double>(sum / (static_cast<long double>(width) * height * a.channels));
  }

 private:
  static long double Value(const PlanarImage& p, int c, int x, int y) {
    if (x < 0 || y < 0 || x >= p.width || y >= p.height) return 0;
    return p.plane(c)[static_cast<size_t>(y) * p.width + x];
  }
  template <typename Term>
  long double Mean(int x, int y, const Term& term) const {
    long double sum = 0;
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) sum += weights[j * side + i] * term(x + i, y + j);
    }
    return sum;
  }
  long double At(const PlanarImage& a, const PlanarImage& b, int c, int x, int y) const {
    const long double mean_a = Mean(x, y, [&](int u, int v) { return Value(a, c, u, v); });
    const long double mean_b = Mean(x, y, [&](int u, int v) { return Value(b, c, u, v); });
    const auto moment = [&](const PlanarImage& p, long double mean_p, const PlanarImage& q, long double mean_q) {
      return covariance_norm *
             Mean(x, y, [&](int u, int v) { return (Value(p, c, u, v) - mean_p) * (Value(q, c, u, v) - mean_q); });
    };
    const long double variance_a = moment(a, mean_a, a, mean_a), variance_b = moment(b, mean_b, b, mean_b);
    const long double covariance = moment(a, mean_a, b, mean_b);
    const long double c1 = 1e-4L * range * range, c2 = 9e-4L * range * range;
    return (2 * mean_a * mean_b + c1) * (2 * covariance + c2) /
           ((mean_a * mean_a + mean_b * mean_b + c1) * (variance_a + variance_b + c2));
  }
};

constexpr double kRounding = 1e-12;  // doubles of size 1 through some thousand additions

TEST(Ssim, NamesAndBack) {
  EXPECT_THAT(SsimPresetNames(), ElementsAre("wang2004", "skimage7", "patn", "gfla51", "neuralbody", "3dgs", "piq"));
  for (const std::string& name : SsimPresetNames()) EXPECT_EQ(ToText(SsimPresetFrom(name).value()), name);
  EXPECT_FALSE(SsimPresetFrom("ssim").has_value());
}

TEST(Ssim, FastEqualsWindowByWindow) {
  // Wider than a strip of the Gaussian filter, so that strips meet; two channels.
  const PlanarImage a = RandomPlanes(270, 23, 2, 1), b = RandomPlanes(270, 23, 2, 2);
  const auto fast = [&](SsimPreset preset) { return Ssim(a, b, preset, 1); };
  EXPECT_NEAR(fast(SsimPreset::kWang2004), SlowSsim::Gaussian(1)(a, b), kRounding);
  EXPECT_NEAR(fast(SsimPreset::kPiq), SlowSsim::Gaussian(1)(a, b), kRounding);
  EXPECT_NEAR(fast(SsimPreset::k3dgs), SlowSsim::Gaussian(1, true)(a, b), kRounding);
  EXPECT_NEAR(fast(SsimPreset::kSkimage7), SlowSsim::Uniform(7, 1)(a, b), kRounding);
  EXPECT_NEAR(fast(SsimPreset::kNeuralBody), SlowSsim::Uniform(7, 2)(a, b), kRounding);
  const PlanarImage large_a = RandomPlanes(60, 56, 1, 3), large_b = RandomPlanes(60, 56, 1, 4);
  EXPECT_NEAR(Ssim(large_a, large_b, SsimPreset::kGfla51, 1), SlowSsim::Uniform(51, 1)(large_a, large_b), kRounding);
}

TEST(Ssim, EveryInstructionSetAgrees) {
  const PlanarImage a = RandomPlanes(270, 23, 2, 1), b = RandomPlanes(270, 23, 2, 2);
  const double expected = SlowSsim::Gaussian(1)(a, b);
  const std::vector<int64_t> targets = ssim_internal::SimdTargets();
  ASSERT_FALSE(targets.empty());
  for (const int64_t target : targets) {
    ssim_internal::ForceSimdTarget(target);
    EXPECT_NEAR(Ssim(a, b, SsimPreset::kWang2004, 1), expected, kRounding) << target;
    EXPECT_EQ(Ssim(a, a, SsimPreset::kWang2004, 1), 1) << target;
  }
  ssim_internal::ForceSimdTarget(0);
}

TEST(Ssim, TheWindowIsTheGaussianItClaims) {
  // A single bright pixel on black against black: every window's SSIM depends on the one weight that falls on it.
  PlanarImage dot{41, 41, 1, std::vector<double>(41 * 41)}, black = dot;
  dot.values[20 * 41 + 20] = 1;
  double sum = 0;
  for (int y = -15; y <= 15; ++y) {
    for (int x = -15; x <= 15; ++x) {
      double w = 0;
      if (std::max(std::abs(x), std::abs(y)) <= 5) {
        double norm = 0;
        for (int i = -5; i <= 5; ++i) norm += std::exp(-i * i / 4.5);
        w = std::exp(-(x * x + y * y) / 4.5) / (norm * norm);
      }
      sum += 1e-4 * 9e-4 / ((w * w + 1e-4) * (w - w * w + 9e-4));
    }
  }
  EXPECT_NEAR(Ssim(black, dot, SsimPreset::kWang2004, 1), sum / (31 * 31), kRounding);
}

TEST(Ssim, ValuesOfIndependentPrograms) {
  // numpy (windows by sliding_window_view) for the first five, PyTorch's conv2d and avg_pool2d for the others.
  const Pair pair = MakePair(80, 64);
  constexpr double kPublished = 1e-13;
  EXPECT_NEAR(Ssim(pair.truth, pair.result, SsimPreset::kWang2004), 0.9665492362422311, kPublished);
  EXPECT_NEAR(Ssim(pair.truth, pair.result, SsimPreset::kPatn), 0.9665492362422311, kPublished);  // range 255
  EXPECT_NEAR(Ssim(pair.truth, pair.result, SsimPreset::kSkimage7), 0.9746182677773927, kPublished);
  EXPECT_NEAR(Ssim(pair.truth, pair.result, SsimPreset::kGfla51), 0.9878094244635850, kPublished);
  EXPECT_NEAR(Ssim(pair.truth, pair.result, SsimPreset::kNeuralBody), 0.9756945345634596, kPublished);
  EXPECT_NEAR(Ssim(pair.truth, pair.result, SsimPreset::k3dgs), 0.9695241110066565, kPublished);
  EXPECT_NEAR(Ssim(pair.truth, pair.result, SsimPreset::kPiq), 0.9665492362422307, kPublished);
  const Pair large = MakePair(390, 401);  // averaged 2×2: 390 / 256 = 1.52
  EXPECT_NEAR(Ssim(large.truth, large.result, SsimPreset::kPiq), 0.9971567496620439, kPublished);
}

TEST(Ssim, NeuralBodyLooksAtTheMasksBox) {
  const Pair pair = MakePair(80, 64);
  PixelMask mask{80, 64, std::vector<uint8_t>(80 * 64)};
  mask.inside[10 * 80 + 45] = 1;  // a box of x 20..70, y 10..39 from two pixels on its boundary
  mask.inside[39 * 80 + 20] = 1;
  mask.inside[25 * 80 + 70] = 1;
  EXPECT_NEAR(Ssim(pair.truth, pair.result, SsimPreset::kNeuralBody, &mask), 0.9758645083986041, 1e-13);
  EXPECT_EQ(Ssim(pair.truth, pair.result, SsimPreset::kWang2004, &mask),
            Ssim(pair.truth, pair.result, SsimPreset::kWang2004));
  mask.inside.assign(mask.inside.size(), 0);
  EXPECT_TRUE(std::isnan(Ssim(pair.truth, pair.result, SsimPreset::kNeuralBody, &mask)));
  mask.inside[0] = 1;
  EXPECT_TRUE(std::isnan(Ssim(pair.truth, pair.result, SsimPreset::kNeuralBody, &mask)));
  const PixelMask other{64, 80, std::vector<uint8_t>(80 * 64, 1)};
  EXPECT_THROW(Ssim(pair.truth, pair.result, SsimPreset::kNeuralBody, &other), std::invalid_argument);
}

TEST(Ssim, ClosedForms) {
  const Pair pair = MakePair(80, 64);
  for (const std::string& name : SsimPresetNames()) {
    const SsimPreset preset = SsimPresetFrom(name).value();
    EXPECT_NEAR(Ssim(pair.truth, pair.truth, preset), 1, 1e-15) << name;
    EXPECT_LT(Ssim(pair.truth, pair.result, preset), 1) << name;
  }
  // Constant pictures: no variance, (2ab + C1) / (a² + b² + C1).
  const Image dark(60, 60, {100, 100, 100}), light(60, 60, {140, 140, 140});
  const auto expected = [](double range) {
    const double c1 = 1e-4 * range * range;
    return (2 * 100 * 140 + c1) / (100 * 100 + 140 * 140 + c1);
  };
  for (const SsimPreset preset :
       {SsimPreset::kWang2004, SsimPreset::kSkimage7, SsimPreset::kGfla51, SsimPreset::kPiq}) {
    EXPECT_NEAR(Ssim(dark, light, preset), expected(255), 1e-9) << ToText(preset);
  }
  EXPECT_NEAR(Ssim(dark, light, SsimPreset::kNeuralBody), expected(510), 1e-9);
  EXPECT_TRUE(std::isnan(Ssim(dark, light, SsimPreset::kPatn)));  // the result has no range
  // A checkerboard against its inverse: covariance is minus the variance.
  PlanarImage board{30, 30, 1, {}}, inverse = board;
  for (int i = 0; i < 900; ++i) {
    board.values.push_back((i / 30 + i) % 2);
    inverse.values.push_back(1 - board.values.back());
  }
  // 49 pixels, 24 or 25 of them white: the same two kinds of window everywhere.
  const double p = 24.0 / 49, q = 25.0 / 49, variance = p * q * 49 / 48;
  const double value = (2 * p * q + 1e-4) * (-2 * variance + 9e-4) / ((p * p + q * q + 1e-4) * (2 * variance + 9e-4));
  EXPECT_NEAR(Ssim(board, inverse, SsimPreset::kSkimage7, 1), value, kRounding);
}

TEST(Ssim, RangeFollowsThePreset) {
  const Pair pair = MakePair(80, 64);
  for (const std::string& name : SsimPresetNames()) {  // bytes with white 255 or the same in [0, 1]
    const SsimPreset preset = SsimPresetFrom(name).value();
    EXPECT_NEAR(Ssim(Scaled(pair.truth, 1 / 255.0), Scaled(pair.result, 1 / 255.0), preset, 1),
                Ssim(pair.truth, pair.result, preset), kRounding)
        << name;
  }
  // patn: the result's own range.
  Image narrow = pair.result;
  for (uint8_t& value : narrow.bgr) value = std::clamp<uint8_t>(value, 20, 200);
  EXPECT_NEAR(Ssim(pair.truth, narrow, SsimPreset::kPatn),
              SlowSsim::Gaussian(180)(PlanarFrom(pair.truth), PlanarFrom(narrow)), kRounding);
}

TEST(Ssim, RefusesWhatItCannotCompare) {
  const Image small(10, 80), large(80, 80);
  EXPECT_THROW(Ssim(small, large, SsimPreset::kWang2004), std::invalid_argument);
  EXPECT_THROW(Ssim(small, small, SsimPreset::kWang2004), std::invalid_argument);
  EXPECT_THROW(Ssim(Image(), Image(), SsimPreset::k3dgs), std::invalid_argument);
  EXPECT_NO_THROW(Ssim(small, small, SsimPreset::kSkimage7));
  EXPECT_NO_THROW(Ssim(Image(1, 1), Image(1, 1), SsimPreset::k3dgs));
  PlanarImage a = RandomPlanes(60, 60, 1, 5), b = a;
  b.values[1234] = std::nan("");
  for (const std::string& name : SsimPresetNames()) {
    EXPECT_TRUE(std::isnan(Ssim(a, b, SsimPresetFrom(name).value(), 1))) << name;
  }
}

}  // namespace
}  // namespace bodyloom::ssim_test
