// SPDX-License-Identifier: Apache-2.0
// Losses against their formulas by loops, and their derivatives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <torch/torch.h>

#include <cmath>
#include <limits>

#include "neural/losses/gan_losses.h"
#include "neural/losses/image_losses.h"
#include "tests/support/gradient_check.h"

namespace bodyloom {
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

}  // namespace
}  // namespace bodyloom
