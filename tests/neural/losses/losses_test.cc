// SPDX-License-Identifier: Apache-2.0
// Losses against their formulas by loops, and their derivatives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <torch/torch.h>

#include <cmath>
#include <limits>

#include "neural/losses/image_losses.h"
#include "tests/support/gradient_check.h"

namespace bodyloom::losses_test {
namespace {

using torch::Tensor;

Tensor RandomLabels(int64_t k, int64_t h, int64_t w) {
  return torch::softmax(2 * torch::randn({1, k, h, w}, torch::kDouble), 1);
}

TEST(ImageLosses, MeansOfWhatTheySay) {
  torch::manual_seed(1);
  const Tensor a = torch::randn({2, 3, 4, 5}, torch::kDouble), b = torch::randn({2, 3, 4, 5}, torch::kDouble);
  const Tensor mask = (torch::rand({2, 1, 4, 5}, torch::kDouble) > 0.5).to(torch::kDouble) * 0.5;
  double sum = 0, masked = 0, weight = 0;
  const auto x = a.accessor<double, 4>(), y = b.accessor<double, 4>(), m = mask.accessor<double, 4>();
  for (int n = 0; n < 2; ++n) {
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 5; ++j) {
          const double d = std::abs(x[n][c][i][j] - y[n][c][i][j]);
          sum += d;
          masked += m[n][0][i][j] * d;
          weight += m[n][0][i][j];
        }
      }
    }
  }
  EXPECT_NEAR(L1Loss(a, b).item<double>(), sum / 120, 1e-12);
  EXPECT_NEAR(MaskedL1Loss(a, b, mask).item<double>(), masked / weight, 1e-12);
  EXPECT_THROW(L1Loss(a, b.slice(2, 0, 3)), std::invalid_argument);
  EXPECT_THROW(MaskedL1Loss(a, b, mask.slice(2, 0, 3)), std::invalid_argument);
}

TEST(ImageLosses, WhatDoesNotCountMayBeNaN) {
  Tensor a = torch::ones({1, 2, 1, 2}), b = torch::zeros({1, 2, 1, 2});
  a.index_put_({0, 1, 0, 1}, std::numeric_limits<float>::quiet_NaN());
  a.requires_grad_(true);
  const Tensor loss = MaskedL1Loss(a, b, torch::tensor({1.0F, 0.0F}).view({1, 1, 1, 2}));
  EXPECT_EQ(loss.item<float>(), 1);
  loss.backward();
  EXPECT_TRUE(torch::isfinite(a.grad()).all().item<bool>());
  const Tensor nothing = MaskedL1Loss(a, b, torch::zeros({1, 1, 1, 2}));
  EXPECT_EQ(nothing.item<float>(), 0);
  nothing.backward();
  EXPECT_TRUE(torch::isfinite(a.grad()).all().item<bool>());
}

TEST(ImageLosses, LabelsAgainstLoops) {
  torch::manual_seed(2);
  const Tensor logits = torch::randn({1, 3, 2, 2}, torch::kDouble), labels = RandomLabels(3, 2, 2);
  const auto z = logits.accessor<double, 4>(), y = labels.accessor<double, 4>();
  double l1 = 0, entropy = 0;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      double total = 0;
      for (int k = 0; k < 3; ++k) total += std::exp(z[0][k][i][j]);
      for (int k = 0; k < 3; ++k) {
        const double p = std::exp(z[0][k][i][j]) / total;
        l1 += std::abs(p - y[0][k][i][j]) / 12;
        entropy -= y[0][k][i][j] * std::log(p) / 4;
      }
    }
  }
  EXPECT_NEAR(SoftLabelL1Loss(logits, labels).item<double>(), l1, 1e-12);
  EXPECT_NEAR(SoftLabelCrossEntropy(logits, labels).item<double>(), entropy, 1e-12);
}

TEST(ImageLosses, OneHotOfClassNumbers) {
  const Tensor classes = torch::tensor({0, 2, 1, 255}, torch::kByte).view({1, 2, 2});
  const Tensor expected = torch::tensor({1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0}, torch::kFloat).view({1, 3, 2, 2});
  EXPECT_TRUE(torch::equal(OneHot(classes, 3), expected)) << OneHot(classes, 3);
}

TEST(ImageLosses, Gradients) {
  torch::manual_seed(3);
  const Tensor a = torch::randn({1, 3, 3, 4}, torch::kDouble), b = torch::randn({1, 3, 3, 4}, torch::kDouble);
  const Tensor mask = (torch::rand({1, 1, 3, 4}, torch::kDouble) > 0.4).to(torch::kDouble);
  const Tensor labels = RandomLabels(3, 3, 4);
  const std::vector<std::function<Tensor(const std::vector<Tensor>&)>> losses = {
      [&](const std::vector<Tensor>& in) { return L1Loss(in[0], b); },
      [&](const std::vector<Tensor>& in) { return MaskedL1Loss(in[0], b, mask); },
      [&](const std::vector<Tensor>& in) { return SoftLabelL1Loss(in[0], labels); },
      [&](const std::vector<Tensor>& in) { return SoftLabelCrossEntropy(in[0], labels); }};
  for (size_t i = 0; i < losses.size(); ++i) {
    const auto check = CheckGradients(losses[i], {a});
    EXPECT_LT(check.max_error, 1e-5) << i;
    EXPECT_GT(check.num_nonzero, i == 1 ? 10 : 30) << i;
  }
}

TEST(GanLosses, AgainstFormulas) {
  const std::vector<Tensor> real = {torch::tensor({0.5, -1.0}, torch::kDouble), torch::tensor({2.0}, torch::kDouble)};
  const std::vector<Tensor> fake = {torch::tensor({-0.25, 0.75}, torch::kDouble),
                                    torch::tensor({-3.0}, torch::kDouble)};
  const auto s = [](double x) { return 1 / (1 + std::exp(-x)); };
  const double d_vanilla = 0.5 * (-(std::log(s(0.5)) + std::log(s(-1.0))) / 2 - std::log(s(2.0)) -
                                  (std::log(1 - s(-0.25)) + std::log(1 - s(0.75))) / 2 - std::log(1 - s(-3.0)));
  EXPECT_NEAR(DiscriminatorLoss(real, fake).item<double>(), d_vanilla, 1e-12);
  EXPECT_NEAR(GeneratorLoss(fake).item<double>(), -(std::log(s(-0.25)) + std::log(s(0.75))) / 2 - std::log(s(-3.0)),
              1e-12);
  EXPECT_NEAR(DiscriminatorLoss(real, fake, GanLossKind::kLeastSquares).item<double>(),
              0.5 * ((0.25 + 4) / 2 + 1 + (0.0625 + 0.5625) / 2 + 9), 1e-12);
  EXPECT_NEAR(GeneratorLoss(fake, GanLossKind::kLeastSquares).item<double>(), (1.5625 + 0.0625) / 2 + 16, 1e-12);
  EXPECT_THROW(DiscriminatorLoss(real, {fake[0]}), std::invalid_argument);
  EXPECT_THROW(GeneratorLoss({}), std::invalid_argument);
}

TEST(GanLosses, Gradients) {
  torch::manual_seed(4);
  for (const GanLossKind kind : {GanLossKind::kNonSaturating, GanLossKind::kLeastSquares}) {
    const auto check = CheckGradients(
        [&](const std::vector<Tensor>& in) {
          return DiscriminatorLoss({in[0]}, {in[1]}, kind) + GeneratorLoss({in[1]}, kind);
        },
        {3 * torch::randn({2, 1, 3, 3}, torch::kDouble), 3 * torch::randn({2, 1, 3, 3}, torch::kDouble)});
    EXPECT_LT(check.max_error, 1e-5);
    EXPECT_EQ(check.num_nonzero, 36);
  }
}

TEST(GanLosses, StayFiniteForLargeLogits) {
  const Tensor large = torch::tensor({-1000.0F, 1000.0F});
  EXPECT_EQ(GeneratorLoss({large}).item<float>(), 500);
  EXPECT_EQ(DiscriminatorLoss({large}, {large}).item<float>(), 500);
}

TEST(PerceptualLoss, SumsTheLayers) {
  torch::manual_seed(5);
  const std::vector<Tensor> f = {torch::randn({1, 2, 4, 4}, torch::kDouble),
                                 torch::randn({1, 3, 2, 2}, torch::kDouble)};
  const std::vector<Tensor> g = {torch::randn({1, 2, 4, 4}, torch::kDouble),
                                 torch::randn({1, 3, 2, 2}, torch::kDouble)};
  const double first = (f[0] - g[0]).abs().mean().item<double>(), second = (f[1] - g[1]).abs().mean().item<double>();
  EXPECT_NEAR(PerceptualLoss(f, g).item<double>(), first + second, 1e-12);
  EXPECT_NEAR(PerceptualLoss(f, g, {0.25, 2}).item<double>(), 0.25 * first + 2 * second, 1e-12);
  EXPECT_THROW(PerceptualLoss(f, {g[0]}), std::invalid_argument);
  EXPECT_THROW(PerceptualLoss(f, g, {1}), std::invalid_argument);
  const auto check = CheckGradients([&](const std::vector<Tensor>& in) { return PerceptualLoss(in, g, {0.25, 2}); }, f);
  EXPECT_LT(check.max_error, 1e-5);
  EXPECT_EQ(check.num_nonzero, 32 + 12);
}

TEST(KlLoss, IsTheDivergenceOfGaussians) {
  // One number: KL(N(m, s^2) | N(0, 1)) = (m^2 + s^2 - 1)/2 - log s.
  const Tensor mean = torch::tensor({1.5, 0.0}, torch::kDouble).view({2, 1});
  const Tensor log_variance = torch::tensor({std::log(0.25), 0.0}, torch::kDouble).view({2, 1});
  EXPECT_NEAR(KlLoss(mean, log_variance).item<double>(), ((2.25 + 0.25 - 1) / 2 - std::log(0.5)) / 2, 1e-12);
  torch::manual_seed(6);
  const auto check = CheckGradients([](const std::vector<Tensor>& in) { return KlLoss(in[0], in[1]); },
                                    {torch::randn({2, 3, 2}, torch::kDouble), torch::randn({2, 3, 2}, torch::kDouble)});
  EXPECT_LT(check.max_error, 1e-5);
  EXPECT_EQ(check.num_nonzero, 24);
}

/// CX with loops.
double SlowContextualSimilarity(const Tensor& features, const Tensor& target, double bandwidth) {
  const int64_t C = features.size(1), N = features.size(2) * features.size(3), M = target.size(2) * target.size(3);
  const Tensor x = features[0].reshape({C, N}).clone(), y = target[0].reshape({C, M}).clone();
  auto a = x.accessor<double, 2>(), b = y.accessor<double, 2>();
  for (int c = 0; c < C; ++c) {
    double mean = 0;
    for (int j = 0; j < M; ++j) mean += b[c][j] / double(M);
    for (int j = 0; j < M; ++j) b[c][j] -= mean;
    for (int i = 0; i < N; ++i) a[c][i] -= mean;
  }
  std::vector<double> best(M, 0);
  for (int i = 0; i < N; ++i) {
    std::vector<double> d(M);
    double smallest = INFINITY, sum = 0;
    for (int j = 0; j < M; ++j) {
      double dot = 0, aa = 0, bb = 0;
      for (int c = 0; c < C; ++c) dot += a[c][i] * b[c][j], aa += a[c][i] * a[c][i], bb += b[c][j] * b[c][j];
      d[j] = (1 - dot / std::sqrt(aa * bb)) / 2;
      smallest = std::min(smallest, d[j]);
    }
    for (int j = 0; j < M; ++j) {
      d[j] = std::exp((1 - d[j] / (smallest + 1e-5)) / bandwidth);
      sum += d[j];
    }
    for (int j = 0; j < M; ++j) best[j] = std::max(best[j], d[j] / sum);
  }
  double mean = 0;
  for (const double value : best) mean += value / double(M);
  return mean;
}

TEST(ContextualLoss, AgainstLoops) {
  torch::manual_seed(7);
  const Tensor features = torch::randn({1, 4, 3, 4}, torch::kDouble),
               target = torch::randn({1, 4, 5, 3}, torch::kDouble);
  for (const double bandwidth : {0.5, 0.1}) {
    ContextualOptions options;
    options.bandwidth = bandwidth;
    const double expected = SlowContextualSimilarity(features, target, bandwidth);
    EXPECT_NEAR(ContextualSimilarity(features, target, options)[0].item<double>(), expected, 1e-9);
    EXPECT_NEAR(ContextualLoss(features, target, options).item<double>(), -std::log(expected), 1e-8);
  }
}

TEST(ContextualLoss, RowsInSeveralPiecesAreTheSame) {
  torch::manual_seed(8);
  const Tensor features = torch::randn({1, 3, 40, 30}, torch::kDouble),
               target = torch::randn({1, 3, 4, 5}, torch::kDouble);
  EXPECT_NEAR(ContextualSimilarity(features, target)[0].item<double>(), SlowContextualSimilarity(features, target, 0.5),
              1e-9);
}

TEST(ContextualLoss, DoesNotMindWhereThingsAre) {
  torch::manual_seed(9);
  const Tensor target = torch::randn({1, 8, 6, 6}), other = torch::randn({1, 8, 6, 6});
  ContextualOptions sharp;
  sharp.bandwidth = 0.1;
  EXPECT_GT(ContextualSimilarity(target, target, sharp)[0].item<double>(), 0.999);
  EXPECT_NEAR(ContextualSimilarity(target.flip(3), target, sharp)[0].item<double>(), 1, 1e-3);
  EXPECT_LT(ContextualSimilarity(other, target, sharp)[0].item<double>(), 0.7);
}

TEST(ContextualLoss, DrawsTheSamePositionsOfBoth) {
  torch::manual_seed(10);
  const Tensor target = torch::randn({1, 8, 20, 20});
  ContextualOptions options;
  options.bandwidth = 0.1;
  options.max_points = 50;
  EXPECT_GT(ContextualSimilarity(target, target, options)[0].item<double>(), 0.999);
  const Tensor other = torch::randn({1, 8, 20, 20});
  const double once = ContextualSimilarity(other, target, options)[0].item<double>();
  EXPECT_EQ(once, ContextualSimilarity(other, target, options)[0].item<double>());
  options.seed = 1;
  EXPECT_NE(once, ContextualSimilarity(other, target, options)[0].item<double>());
}

TEST(ContextualLoss, Gradients) {
  torch::manual_seed(11);
  const auto check =
      CheckGradients([](const std::vector<Tensor>& in) { return ContextualLoss(in[0], in[1]); },
                     {torch::randn({2, 3, 3, 3}, torch::kDouble), torch::randn({2, 3, 2, 4}, torch::kDouble)});
  EXPECT_LT(check.max_error, 1e-5);
  EXPECT_EQ(check.num_compared, 54 + 48);
  EXPECT_GT(check.num_nonzero, 70);
  EXPECT_THROW(ContextualLoss(torch::zeros({1, 3, 2, 2}), torch::zeros({1, 4, 2, 2})), std::invalid_argument);
}

// A flat image: every feature equals the mean.
TEST(ContextualLoss, StaysFiniteWhereThereIsNothing) {
  Tensor flat = torch::ones({1, 3, 4, 4}).requires_grad_(true);
  ContextualLoss(flat, torch::ones({1, 3, 4, 4})).backward();
  EXPECT_TRUE(torch::isfinite(flat.grad()).all().item<bool>());
}

}  // namespace
}  // namespace bodyloom::losses_test
