// SPDX-License-Identifier: Apache-2.0
/// Muon: momentum whose matrices are made orthogonal before each step.
///
///   M ← μ M + G,   U = orthogonal factor of (G + μ M),   W ← (1 − ηλ) W − 0.2 η √max(m, n) U
///
/// for a weight of m outputs and n inputs (all taps of a convolution together). The orthogonal factor comes from five
/// Newton–Schulz iterations, which leave its singular values between about 0.7 and 1.2; the factor 0.2 √max(m, n) gives
/// the step the size of an Adam step, so that one learning rate η and decay λ serve both. For weights in the middle of
/// a network; biases, norms and outputs belong to Adam.
/// Sources: Jordan et al., "Muon: an optimizer for hidden layers in neural networks" (2024); Liu et al., "Muon is
/// scalable for LLM training" (2025), for the factor.
#pragma once

#include <torch/torch.h>

#include <vector>

namespace bodyloom {

/// The nearest orthogonal matrix (U Vᵀ of U Σ Vᵀ) to an m×n matrix, roughly: singular values end near 1, zeros stay.
torch::Tensor ApproximateOrthogonalFactor(const torch::Tensor& matrix);

class Muon {
 public:
  struct Options {
    double momentum = 0.95;
    double weight_decay = 0;
  };

  /// Weights with two dimensions or more; those beyond the first count as inputs.
  Muon(std::vector<torch::Tensor> weights, const Options& options);

  /// One step by the weights' gradients. Weights without a gradient stay.
  void Step(double learning_rate);

  /// M of each weight, in their order: what a checkpoint keeps.
  [[nodiscard]] std::vector<torch::Tensor>& momenta() { return momenta_; }

 private:
  std::vector<torch::Tensor> weights_, momenta_;
  Options options_;
};

}  // namespace bodyloom
