// SPDX-License-Identifier: Apache-2.0
/// A U-Net that completes maps: pooling down, bilinear up. Internal: includes LibTorch.
///
/// Widths w_0 … w_L: at level l < L two convolutions to w_l, then 2×2 max-pooling; two convolutions to w_L at the
/// bottom; for l = L−1 … 0 bilinear enlargement by 2, the map of level l beside it (the enlarged channels first), two
/// convolutions to w_l. A convolution is Conv 3×3 IN ReLU, without bias, which IN would remove. A last 3×3 convolution
/// (with bias) sees the finest map and, beside it, the network's own input: IN takes every map's mean away, and with it
/// how bright a person's clothes are.
/// Source: Ronneberger et al., MICCAI 2015; Sarkar et al., "Neural Re-Rendering of Humans from a Single Image", ECCV
/// 2020, Section 3.2, which gives levels, pooling and enlargement but neither widths nor norms nor what is passed by.
#pragma once

#include <torch/torch.h>

#include <vector>

namespace bodyloom {

struct FeatureUNetOptions {
  int in = 0, out = 0;
  std::vector<int> widths;  ///< w_0 … w_L, at least two
};

struct FeatureUNetImpl : torch::nn::Module {
  explicit FeatureUNetImpl(const FeatureUNetOptions& options);
  /// B×in×H×W → B×out×H×W, linear. H and W are multiples of 2^L, and at least 2^(L+1); std::invalid_argument otherwise.
  torch::Tensor forward(torch::Tensor x);

  FeatureUNetOptions options;
  std::vector<torch::nn::Conv2d> encoder;  ///< two a level, the bottom's last: encoder0a, encoder0b, …
  std::vector<torch::nn::Conv2d> decoder;  ///< two a level, finest first: decoder0a, …
  torch::nn::Conv2d last{nullptr};
};
TORCH_MODULE(FeatureUNet);

}  // namespace bodyloom
