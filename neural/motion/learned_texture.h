// SPDX-License-Identifier: Apache-2.0
/// A learned texture, the appearance of a person whatever the motion: values by texel, trained with the networks.
/// Internal: includes LibTorch.
///
///   x = gain · Π T          C channels at the pixels that see the body, 0 elsewhere
///   A x, B x                what the classes' and the colour's logits are without anything that the networks add
/// Source of T: Thies, Zollhöfer, Nießner, "Deferred Neural Rendering", SIGGRAPH 2019; A and B are this project's.
#pragma once

#include <torch/torch.h>

namespace bodyloom {

struct LearnedTextureImpl : torch::nn::Module {
  /// `num_labels` 0: no A. T begins with zeros.
  LearnedTextureImpl(int size, int features, int num_labels);

  /// x of B×2×h×w coordinates and B×1×h×w body.
  torch::Tensor forward(const torch::Tensor& uv, const torch::Tensor& body);

  torch::Tensor values;                                                  ///< T: 1×C×S×S
  torch::nn::Conv2d colour_of_texel{nullptr}, labels_of_texel{nullptr};  ///< B, A
};
TORCH_MODULE(LearnedTexture);

}  // namespace bodyloom
