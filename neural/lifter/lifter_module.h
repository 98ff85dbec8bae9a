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

}  // namespace bodyloom
