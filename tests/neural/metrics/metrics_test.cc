// SPDX-License-Identifier: Apache-2.0
// LPIPS, tLPIPS and contextual similarity against reference implementations in double precision.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <torch/torch.h>

#include <cmath>
#include <random>

#include "neural/base/image_tensor.h"
#include "neural/losses/image_losses.h"
#include "neural/metrics/lpips.h"
#include "neural/metrics/person_scores.h"
#include "neural/metrics/pixel_metrics.h"
#include "neural/networks/vgg.h"
#include "tests/neural/metrics/named_features.h"

namespace bodyloom::metrics_test {
namespace {

using ::testing::HasSubstr;
using torch::Tensor;

Image RandomImage(int width, int height, uint32_t seed) {
  std::mt19937 random(seed);
  Image image(width, height);
  for (uint8_t& v : image.bgr) v = static_cast<uint8_t>(random() & 255U);
  return image;
}

Tensor WeightOf(const NamedWeights& weights, const std::string& name) {
  const NamedArray& array = weights.at(name);
  return torch::tensor(array.values, torch::kFloat).view(array.shape).to(torch::kDouble);
}

/// LPIPS v0.1 of AlexNet from the formula, in double precision and with loops behind the convolutions.
double SlowLpips(const Image& a, const Image& b, const NamedWeights& trunk, const NamedWeights& heads) {
  const auto features_of = [&](const Image& image) {
    Tensor x = torch::empty({1, 3, image.height, image.width}, torch::kDouble);
    const std::array<double, 3> shift = {-.030, -.088, -.188}, scale = {.458, .448, .450};
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i < image.height; ++i) {
        for (int j = 0; j < image.width; ++j) {
          x[0][c][i][j] = (image.pixel(j, i)[2 - c] / 127.5 - 1 - shift[c]) / scale[c];
        }
      }
    }
    std::vector<Tensor> taps;
    const auto convolve = [&](const std::string& n, int stride, int padding) {
      x = torch::relu(torch::conv2d(x, WeightOf(trunk, "features." + n + ".weight"),
                                    WeightOf(trunk, "features." + n + ".bias"), stride, padding));
      taps.push_back(x);
    };
    convolve("0", 4, 2);
    x = torch::max_pool2d(x, 3, 2);
    convolve("3", 1, 2);
    x = torch::max_pool2d(x, 3, 2);
    convolve("6", 1, 1);
    convolve("8", 1, 1);
    convolve("10", 1, 1);
    return taps;
  };
  const auto fa = features_of(a), fb = features_of(b);
  double total = 0;
  for (int k = 0; k < 5; ++k) {
    const NamedArray& head = heads.at("lin" + std::to_string(k) + ".model.1.weight");
    const auto x = fa[k].accessor<double, 4>(), y = fb[k].accessor<double, 4>();
    const int64_t C = x.size(1), H = x.size(2), W = x.size(3);
    for (int i = 0; i < H; ++i) {
      for (int j = 0; j < W; ++j) {
        double nx = 0, ny = 0;
        for (int c = 0; c < C; ++c) nx += x[0][c][i][j] * x[0][c][i][j], ny += y[0][c][i][j] * y[0][c][i][j];
        nx = std::sqrt(nx) + 1e-10;
        ny = std::sqrt(ny) + 1e-10;
        for (int c = 0; c < C; ++c) {
          total += head.values[c] * std::pow(x[0][c][i][j] / nx - y[0][c][i][j] / ny, 2) / double(H * W);
        }
      }
    }
  }
  return total;
}

TEST(Lpips, LoadedWeightsGiveTheFormulasValue) {
  const NamedWeights trunk = AlexNetWeights(), heads = HeadWeights();
  Lpips lpips;
  const Image a = RandomImage(40, 33, 1), b = RandomImage(40, 33, 2);
  EXPECT_TRUE(lpips.Distance(a, b).random_features);
  const LpipsFeatures old = lpips.Features(a);
  lpips.Load(trunk, "alexnet.pth", heads, "alex.pth");
  const LpipsValue value = lpips.Distance(a, b);
  EXPECT_FALSE(value.random_features);
  const double expected = SlowLpips(a, b, trunk, heads);
  EXPECT_NEAR(value.value, expected, 1e-4 * expected);
  EXPECT_GT(expected, 0.01);
  EXPECT_THROW(static_cast<void>(lpips.Distance(old, lpips.Features(b))), std::invalid_argument);
}

TEST(Lpips, IsASymmetricDistance) {
  for (const LpipsTrunk trunk : {LpipsTrunk::kAlexNet, LpipsTrunk::kVgg16}) {
    const Lpips lpips({trunk, 16, 1});
    const Image a = RandomImage(48, 32, 1);
    Image near = a;
    for (size_t i = 0; i < near.bgr.size(); i += 7) near.bgr[i] = static_cast<uint8_t>(near.bgr[i] ^ 16U);
    const Image far = RandomImage(48, 32, 2);
    EXPECT_EQ(lpips.Distance(a, a).value, 0);
    EXPECT_EQ(lpips.Distance(a, far).value, lpips.Distance(far, a).value);
    EXPECT_GT(lpips.Distance(a, far).value, 4 * lpips.Distance(a, near).value);
    EXPECT_GT(lpips.Distance(a, near).value, 0);
    EXPECT_TRUE(lpips.has_random_features());
    EXPECT_THROW(static_cast<void>(lpips.Distance(a, RandomImage(32, 48, 1))), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(lpips.Features(RandomImage(15, 48, 1))), std::invalid_argument);
  }
}

TEST(Lpips, FaultsNameTheFileAndTheTensor) {
  const NamedWeights trunk = AlexNetWeights(), heads = HeadWeights();
  const auto error_of = [](const NamedWeights& t, const NamedWeights& h) {
    Lpips lpips;
    std::string text;
    try {
      lpips.Load(t, "alexnet.pth", h, "alex.pth");
    } catch (const std::runtime_error& error) {
      text = error.what();
    }
    EXPECT_TRUE(lpips.has_random_features());
    return text;
  };
  NamedWeights bad = heads;
  bad["lin2.model.1.weight"].shape = {1, 384};
  EXPECT_EQ(error_of(trunk, bad), "alex.pth: tensor lin2.model.1.weight: shape [1, 384], expected [1, 384, 1, 1]");
  bad = heads;
  bad.erase("lin4.model.1.weight");
  EXPECT_THAT(error_of(trunk, bad), HasSubstr("alex.pth: no tensor lin4.model.1.weight"));
  bad = trunk;
  bad.erase("features.8.bias");
  EXPECT_THAT(error_of(bad, heads), HasSubstr("alexnet.pth: no tensor features.8.bias"));
  Lpips small({LpipsTrunk::kAlexNet, 4, 1});
  EXPECT_THROW(small.Load(trunk, "a", heads, "b"), std::exception);
}

TEST(TemporalLpips, ComparesChangesWithChanges) {
  const Lpips lpips({LpipsTrunk::kAlexNet, 16, 1});
  std::vector<Image> result, truth;
  for (uint32_t t = 0; t < 3; ++t) {
    result.push_back(RandomImage(36, 36, t));
    truth.push_back(RandomImage(36, 36, 10 + t));
  }
  TemporalLpips temporal(lpips);
  double sum = 0, expected = 0;
  for (int t = 0; t < 3; ++t) {
    const auto frame = temporal.Add(result[t], truth[t]);
    EXPECT_EQ(frame.lpips, lpips.Distance(result[t], truth[t]).value);
    EXPECT_EQ(frame.tlpips.has_value(), t > 0);
    EXPECT_TRUE(frame.random_features);
    sum += frame.lpips;
    if (t == 0) continue;
    const double change =
        std::abs(lpips.Distance(result[t], result[t - 1]).value - lpips.Distance(truth[t], truth[t - 1]).value);
    EXPECT_NEAR(*frame.tlpips, change, 1e-12);
    EXPECT_GT(change, 0);
    expected += change;
  }
  EXPECT_EQ(temporal.Mean().frames, 3);
  EXPECT_NEAR(temporal.Mean().lpips, sum / 3, 1e-12);
  EXPECT_NEAR(temporal.Mean().tlpips, expected / 2, 1e-12);
  EXPECT_TRUE(temporal.Mean().random_features);
  // A still result of a still truth is as steady as the truth, whatever it looks like.
  TemporalLpips still(lpips);
  still.Add(result[0], truth[0]);
  EXPECT_EQ(*still.Add(result[0], truth[0]).tlpips, 0);
  EXPECT_EQ(TemporalLpips(lpips).Mean().tlpips, 0);
  // After a cut a frame follows none, and does not count among those that do.
  temporal.Restart();
  EXPECT_FALSE(temporal.Add(result[0], truth[1]).tlpips.has_value());
  EXPECT_EQ(temporal.Mean().frames, 4);
  EXPECT_NEAR(temporal.Mean().tlpips, expected / 2, 1e-12);
}

/// A window of 40×36 of a picture, its top-left pixel at (x, y); black outside.
Image WindowAt(const Image& image, int x, int y) {
  Image window(40, 36);
  for (int row = 0; row < 36; ++row) {
    for (int column = 0; column < 40; ++column) {
      const int from_x = x + column, from_y = y + row;
      if (from_x < 0 || from_y < 0 || from_x >= image.width || from_y >= image.height) continue;
      for (int c = 0; c < 3; ++c) window.pixel(column, row)[c] = image.pixel(from_x, from_y)[c];
    }
  }
  return window;
}

TEST(TemporalLpips, AWindowThatJumpsIsNoChange) {
  const Lpips lpips({LpipsTrunk::kAlexNet, 16, 1});
  // People who stand still on black, 20 pixels wide and high, in windows that follow nobody in particular.
  const Image result = RandomImage(20, 20, 1), truth = RandomImage(20, 20, 2);
  TemporalLpips temporal(lpips), blind(lpips);
  int last_x = 0, last_y = 0;
  for (const auto& [x, y] : {std::pair(-9, -8), std::pair(-12, -8), std::pair(-5, -14), std::pair(-5, -14)}) {
    const Image s = WindowAt(result, x, y), g = WindowAt(truth, x, y);
    const auto frame = temporal.Add(s, g, last_x - x, last_y - y);
    blind.Add(s, g);
    EXPECT_NEAR(frame.tlpips.value_or(0), 0, 1e-12) << x;
    last_x = x, last_y = y;
  }
  EXPECT_EQ(temporal.Mean().pairs, 3);
  EXPECT_GT(blind.Mean().tlpips, 0.01) << "nothing to be taken for a change";
}

TEST(LpipsFrom, TakesTrainedWeightsWhereBothAreThere) {
  const WeightsFrom trunk = {AlexNetWeights(), "alexnet.pth"}, heads = {HeadWeights(), "lpips_alex.pth"};
  const Image a = RandomImage(40, 33, 1), b = RandomImage(40, 33, 2);
  const double expected = SlowLpips(a, b, trunk.weights, heads.weights);
  EXPECT_NEAR(LpipsFrom(trunk, heads).Distance(a, b).value, expected, 1e-4 * expected);
  const double substitute = Lpips().Distance(a, b).value;
  for (const bool has_trunk : {false, true}) {
    const Lpips lpips = has_trunk ? LpipsFrom(trunk, {}) : LpipsFrom({}, heads);
    EXPECT_TRUE(lpips.has_random_features());
    EXPECT_EQ(lpips.Distance(a, b).value, substitute);
  }
  EXPECT_EQ(LpipsName("tlpips", false), "tlpips_alex");
  EXPECT_EQ(LpipsName("lpips", true), "lpips_random_features");
}

TEST(ContextualMetric, IsTheSumOfTwoLayers) {
  const ContextualMetric metric(16);
  const Image a = RandomImage(32, 24, 1), b = RandomImage(32, 24, 2);
  FeatureNetworkOptions options;
  options.trunk = FeatureTrunk::kVgg19;
  options.taps = {13, 22};  // relu3_2, relu4_2
  options.normalise = false;
  options.random_features_divisor = 16;
  FeatureNetwork vgg(options);
  const auto fa = vgg(ToTensor(a)), fb = vgg(ToTensor(b));
  ContextualOptions sharp;
  sharp.bandwidth = 0.1;
  const double first = ContextualSimilarity(fa[0], fb[0], sharp)[0].item<double>();
  const double second = ContextualSimilarity(fa[1], fb[1], sharp)[0].item<double>();
  const ContextualValue value = metric(a, b);
  EXPECT_NEAR(value.similarity, first + second, 1e-6);
  EXPECT_NEAR(value.distance, -std::log(first) - std::log(second), 1e-5);
  EXPECT_TRUE(value.random_features);
  const ContextualValue same = metric(a, a);
  EXPECT_GT(same.similarity, 1.99);
  EXPECT_LT(same.distance, 0.01);
  EXPECT_GT(value.distance, 10 * same.distance);
  EXPECT_GT(metric(a, RandomImage(16, 40, 3)).distance, 0) << "sizes may differ";
}

TEST(ClassOverlap, CountsWhatBothSay) {
  ClassOverlap overlap(4);
  EXPECT_TRUE(std::isnan(overlap.MeanIou(false)));
  EXPECT_TRUE(std::isnan(overlap.ForegroundIou()));
  overlap.Add({0, 0, 1, 1, 1, 3}, {0, 1, 1, 1, 2, 0});
  EXPECT_DOUBLE_EQ(overlap.Iou(0), 1.0 / 3);
  EXPECT_DOUBLE_EQ(overlap.Iou(1), 2.0 / 4);
  EXPECT_EQ(overlap.Iou(2), 0);
  EXPECT_EQ(overlap.Iou(3), 0);
  EXPECT_DOUBLE_EQ(overlap.ForegroundIou(), 3.0 / 5);
  EXPECT_DOUBLE_EQ(overlap.MeanIou(true), 0.5 / 2);  // class 3 is not there
  EXPECT_DOUBLE_EQ(overlap.MeanIou(false), 0.5 / 3);
  EXPECT_THROW(overlap.Add(std::vector<uint8_t>(1), std::vector<uint8_t>()), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::metrics_test
