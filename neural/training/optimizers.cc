// SPDX-License-Identifier: Apache-2.0
#include "neural/training/optimizers.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using torch::Tensor;

// Coefficients of the quintic a x + b x³ + c x⁵ (Jordan et al.): steep at zero, near 1 above 0.05 after five
// iterations.
constexpr double kA = 3.4445, kB = -4.7750, kC = 2.0315;
constexpr int kRounds = 5;

/// m×k · k×n as a convolution, whose library is several times faster than the packaged BLAS.
Tensor Multiply(const Tensor& a, const Tensor& b) { return torch::conv1d(b.unsqueeze(0), a.unsqueeze(-1)).squeeze(0); }

}  // namespace

Tensor ApproximateOrthogonalFactor(const Tensor& matrix) {
  const bool tall = matrix.size(0) > matrix.size(1);
  Tensor x = (tall ? matrix.t() : matrix).contiguous();
  x = x / (x.norm() + 1e-7);
  for (int round = 0; round < kRounds; ++round) {
    const Tensor square = Multiply(x, x.t().contiguous());
    x = kA * x + Multiply(kB * square + kC * Multiply(square, square), x);
  }
  return tall ? x.t() : x;
}

Muon::Muon(std::vector<Tensor> weights, const Options& options) : weights_(std::move(weights)), options_(options) {
  for (const Tensor& weight : weights_) {
    BODYLOOM_CHECK(weight.dim() >= 2, "Muon: a weight of ", weight.dim(), " dimensions, expected at least 2");
    momenta_.push_back(torch::zeros_like(weight));
  }
}

void Muon::Step(double learning_rate) {
  const torch::NoGradGuard no_grad;
  for (size_t i = 0; i < weights_.size(); ++i) {
    Tensor& weight = weights_[i];
    if (!weight.grad().defined()) continue;
    momenta_[i].mul_(options_.momentum).add_(weight.grad());
    const Tensor ahead = weight.grad() + options_.momentum * momenta_[i];
    const Tensor turn = ApproximateOrthogonalFactor(ahead.reshape({weight.size(0), -1}));
    const double size = 0.2 * std::sqrt(static_cast<double>(std::max(turn.size(0), turn.size(1))));
    weight.mul_(1 - learning_rate * options_.weight_decay).add_(turn.reshape(weight.sizes()), -learning_rate * size);
  }
}

void AverageWeights(const torch::nn::Module& learner, int64_t n, double share, torch::nn::Module* average) {
  BODYLOOM_CHECK(n >= 1 && share > 0 && share <= 0.5, "weight average: step ", n, " with a share of ", share,
                 ", expected a step of at least 1 and a share in (0, 0.5]");
  const torch::NoGradGuard no_grad;
  const double gamma = 1 / share - 2;
  const double weight = (gamma + 1) / (static_cast<double>(n) + gamma);
  const auto each = [](const auto& from, const auto& to, const auto& move) {
    bool same = from.size() == to.size();
    for (const auto& item : from) {
      const Tensor* target = same ? to.find(item.key()) : nullptr;
      same = target != nullptr && target->sizes() == item.value().sizes();
      if (!same) break;
      move(item.value(), *target);
    }
    BODYLOOM_CHECK(same, "weight average: two networks that differ");
  };
  each(learner.named_parameters(), average->named_parameters(),
       [&](const Tensor& w, const Tensor& mean) { n == 1 ? mean.copy_(w) : mean.lerp_(w, weight); });
  each(learner.named_buffers(), average->named_buffers(), [](const Tensor& w, const Tensor& mean) { mean.copy_(w); });
}

}  // namespace bodyloom
