// SPDX-License-Identifier: Apache-2.0
/// Optimizers, learning rate schedules and averaging of weights. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/base/check.h"

namespace bodyloom {

/// Adam with β₁ 0.5, β₂ 0.999, usual for image-to-image networks (Isola et al., CVPR 2017).
inline std::unique_ptr<torch::optim::Adam> MakeAdam(const torch::nn::Module& module, double rate) {
  return std::make_unique<torch::optim::Adam>(module.parameters(), torch::optim::AdamOptions(rate).betas({0.5, 0.999}));
}

/// Sets the learning rate of all parameters of an optimizer.
inline void SetRate(torch::optim::Adam* optimizer, double rate) {
  for (auto& group : optimizer->param_groups()) static_cast<torch::optim::AdamOptions&>(group.options()).lr(rate);
}

inline void SetRate(torch::optim::AdamW* optimizer, double rate) {
  for (auto& group : optimizer->param_groups()) static_cast<torch::optim::AdamWOptions&>(group.options()).lr(rate);
}

/// Enables or disables gradients of a module's parameters, for instance of a discriminator in the generator's step.
inline void RequireGradients(torch::nn::Module* module, bool on) {
  for (torch::Tensor& parameter : module->parameters()) parameter.set_requires_grad(on);
}

// Learning rates as functions of the step, 0 … steps − 1.

/// `rate` for the first half, then linear decay to 0 at `steps`.
inline double LinearDecayOverLastHalf(double rate, int64_t step, int64_t steps) {
  BODYLOOM_CHECK(steps > 0 && step >= 0, "learning rate: step ", step, " of ", steps);
  const double left = 1 - static_cast<double>(step) / static_cast<double>(steps);
  return rate * std::clamp(2 * left, 0.0, 1.0);
}

/// rate · min(1, (step + 1)/warmup) · ½ (1 + cos(π step/steps)).
inline double CosineWithWarmup(double rate, int64_t step, int64_t steps, int64_t warmup_steps) {
  BODYLOOM_CHECK(steps > 0 && step >= 0 && warmup_steps >= 0, "learning rate: step ", step, " of ", steps, ", ",
                 warmup_steps, " to warm up");
  const double warm = std::min(1.0, (static_cast<double>(step) + 1) / std::max<double>(1, double(warmup_steps)));
  const double done = std::min(1.0, static_cast<double>(step) / static_cast<double>(steps));
  return rate * warm * 0.5 * (1 + std::cos(M_PI * done));
}

// Muon: momentum matrices are orthogonalised before each step.
//
// M ← μ M + G,   U = orthogonal factor of (G + μ M),   W ← (1 − ηλ) W − 0.2 η √max(m, n) U
//
// for a weight of m outputs and n inputs (all taps of a convolution together). The orthogonal factor comes from five
// Newton–Schulz iterations, which leave its singular values between about 0.7 and 1.2; the factor 0.2 √max(m, n) gives
// the step the size of an Adam step, so that both share the learning rate η and decay λ. For hidden weights of a
// network; biases, norms and outputs should use Adam.
// Sources: Jordan et al., "Muon: an optimizer for hidden layers in neural networks" (2024); Liu et al., "Muon is
// scalable for LLM training" (2025), for the factor.

/// The nearest orthogonal matrix (U Vᵀ of U Σ Vᵀ) to an m×n matrix, approximately: singular values become near 1, zeros
/// stay.
torch::Tensor ApproximateOrthogonalFactor(const torch::Tensor& matrix);

class Muon {
 public:
  struct Options {
    double momentum = 0.95;
    double weight_decay = 0;
  };

  /// `weights`: of two dimensions or more; those beyond the first count as inputs.
  Muon(std::vector<torch::Tensor> weights, const Options& options);

  /// Performs one step by the weights' gradients. Weights without a gradient stay.
  void Step(double learning_rate);

  /// M of each weight, in their order: the state for a checkpoint.
  [[nodiscard]] std::vector<torch::Tensor>& momenta() { return momenta_; }

 private:
  std::vector<torch::Tensor> weights_, momenta_;
  Options options_;
};

// Average of a network's weights over the last part of a run.
//
//   w̄_n = w̄_{n−1} + (w_n − w̄_{n−1}) (γ + 1) / (n + γ),   γ = 1 / share − 2,   n = 1, 2, … steps
// Step t has a weight of about t^γ: the mean age is `share` of the steps for any length of the run. Adam's last steps
// fluctuate around an optimum; their mean is nearer to it for any learning rate. Source: polynomial-decay averaging,
// Shamir and Zhang, "Stochastic gradient descent for non-smooth optimization", ICML 2013.

/// Updates `average` by `learner`, which has the same parameters and buffers; buffers are copied. n counts from 1,
/// where the average equals the learner. Throws std::invalid_argument for networks that differ, for n below 1 and for a
/// share outside (0, 0.5].
void AverageWeights(const torch::nn::Module& learner, int64_t n, double share, torch::nn::Module* average);

}  // namespace bodyloom
