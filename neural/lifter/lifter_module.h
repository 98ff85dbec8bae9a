// SPDX-License-Identifier: Apache-2.0
/// The lifter (geometry/scene/lifter_weights.h) as a LibTorch module, and conversion of its weights to plain arrays.
/// Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "geometry/scene/lifter_weights.h"

namespace bodyloom {

struct LifterModuleImpl : torch::nn::Module {
  LifterModuleImpl(int num_inputs, int width, const std::vector<int>& dilations);
  /// B×num_inputs×T → B×LifterOutput::kSize×T.
  torch::Tensor forward(const torch::Tensor& x);

  torch::nn::Conv1d input{nullptr}, output{nullptr};
  torch::nn::LayerNorm norm{nullptr};
  std::vector<torch::nn::LayerNorm> norms;
  std::vector<torch::nn::Conv1d> dilated, mix;
  std::vector<int> dilations;
};
TORCH_MODULE(LifterModule);

/// Converts the module's weights to plain arrays.
LifterWeights ExportLifter(const LifterModule& module);
/// Copies weights into the module; throws std::invalid_argument when the sizes differ.
void ImportLifter(const LifterWeights& weights, LifterModule* module);

// The lifter's training loss and its errors.
//
// A landmark with error d = (d_xy, d_z), scales σ_xy, σ_z: r² = |d_xy|²/σ_xy² + d_z²/σ_z², density
// exp(−r) / (8π σ_xy² σ_z), a Laplace density in three dimensions, so
//   nll = r + 2 log σ_xy + log σ_z (+ log 8π).
// A limb's landmarks share hypotheses m of weight π_m: nll = −log Σ_m π_m exp(−Σ_i nll_mi); q_m are their posterior
// weights, constant where they weight distances.
//   loss = Σ_i w_i |d_i| (limbs: Σ_m q_m |d_mi|) + nll_weight · mean nll + velocity_weight · mean |Δp − Δp̂|
//        + 0.1 (up: |u − û|/σ + log σ) + 0.05 (contact: binary cross entropy)
// with w = 1.5 for limbs, 0.5 for the face, 1 for shoulders and hips, normalised to mean 1.

struct LifterTargets {
  torch::Tensor points;   ///< B×T×21×3
  torch::Tensor up;       ///< B×T×3
  torch::Tensor contact;  ///< B×T×2
};

struct LifterLossOptions {
  double nll_weight = 0.05;
  double velocity_weight = 0.3;
};

struct LifterLoss {
  torch::Tensor total;  ///< scalar with gradient
  double distance = 0, nll = 0, velocity = 0, up = 0, contact = 0;
};

/// `output` is B×LifterOutput::kSize×T.
LifterLoss ComputeLifterLoss(const torch::Tensor& output, const LifterTargets& targets,
                             const LifterLossOptions& options);

/// B×T×21×3: torso landmarks and, for each limb, the hypothesis of maximum weight.
torch::Tensor LikeliestPoints(const torch::Tensor& output);
/// The same with each limb's hypothesis nearest to the truth: the result of a perfect choice.
torch::Tensor NearestPoints(const torch::Tensor& output, const torch::Tensor& truth);

}  // namespace bodyloom
