// SPDX-License-Identifier: Apache-2.0
/// The picture refiner (render/person/refiner_weights.h) as a module that learns. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "bodyloom/render/person/refiner_weights.h"

namespace bodyloom {

struct RefinerModuleImpl : torch::nn::Module {
  /// Kernels are Kaiming's for relu, biases 0; the last convolution is all zeros: an untrained refiner changes nothing.
  RefinerModuleImpl();
  /// B×PersonPlane::kCount×H×W → B×4×H×W, what ChangedPerson() takes, alpha near the outline (KeepNearOutline()). Throws
  /// std::invalid_argument for sides that are not multiples of kRefinerMultiple.
  torch::Tensor forward(const torch::Tensor& planes);

  std::vector<torch::nn::Conv2d> convolutions;
};
TORCH_MODULE(RefinerModule);

/// The person as the refiner changes it (ChangedPerson()), B×4×H×W.
torch::Tensor ChangedPerson(const torch::Tensor& planes, const torch::Tensor& change);

/// The module's numbers as plain arrays.
RefinerWeights ExportRefiner(const RefinerModule& module);
/// The other way; throws std::invalid_argument for weights that are not valid.
void ImportRefiner(const RefinerWeights& weights, RefinerModule* module);

}  // namespace bodyloom
