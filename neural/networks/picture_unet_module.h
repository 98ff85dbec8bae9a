// SPDX-License-Identifier: Apache-2.0
/// A picture U-Net (render/image/parser_weights.h) as a module that learns. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "render/image/parser_weights.h"

namespace bodyloom {

struct PictureUnetModuleImpl : torch::nn::Module {
  /// Kernels are Kaiming's for relu, biases 0; the last convolution is all zeros, and so is the untrained answer.
  explicit PictureUnetModuleImpl(PictureUnetPlanes planes);
  /// B×planes.in×H×W → B×planes.out×H×W. Throws std::invalid_argument for other planes, and for sides that are not
  /// multiples of kPictureUnetMultiple.
  torch::Tensor forward(const torch::Tensor& x);

  PictureUnetPlanes planes;
  std::vector<torch::nn::Conv2d> convolutions;  ///< in the order of PictureUnetLayers(), and named like them
};
TORCH_MODULE(PictureUnetModule);

/// The module's numbers as plain arrays.
PictureUnetWeights ExportPictureUnet(const PictureUnetModule& module);
/// The other way; throws std::invalid_argument for weights that are not valid.
void ImportPictureUnet(const PictureUnetWeights& weights, PictureUnetModule* module);

}  // namespace bodyloom
