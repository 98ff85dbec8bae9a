// SPDX-License-Identifier: Apache-2.0
/// The U-Net of render/image/parser_weights.h as a trainable module. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "render/image/parser_weights.h"

namespace bodyloom {

struct ImageUnetModuleImpl : torch::nn::Module {
  /// Kernels have Kaiming initialisation for relu, biases are 0; the last convolution, and hence the untrained output,
  /// is zero.
  explicit ImageUnetModuleImpl(ImageUnetPlanes planes);
  /// B×planes.in×H×W → B×planes.out×H×W. Throws std::invalid_argument for other planes, and for sides that are not
  /// multiples of kImageUnetMultiple.
  torch::Tensor forward(const torch::Tensor& x);

  ImageUnetPlanes planes;
  std::vector<torch::nn::Conv2d> convolutions;  ///< in the order of ImageUnetLayers(), and named like them
};
TORCH_MODULE(ImageUnetModule);

/// Converts the module's weights to plain arrays.
ImageUnetWeights ExportImageUnet(const ImageUnetModule& module);
/// Copies weights into the module; throws std::invalid_argument for weights that are not valid.
void ImportImageUnet(const ImageUnetWeights& weights, ImageUnetModule* module);

}  // namespace bodyloom
