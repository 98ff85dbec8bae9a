// SPDX-License-Identifier: Apache-2.0
/// The generator that turns a map of features into a picture by way of residual blocks. Internal: includes LibTorch.
///
/// ReflectPad(3) Conv(in, n, 7); three times Conv(c, 2c, 3, stride 2, padding 1); residual blocks x + F(x), F =
/// ReflectPad(1) Conv(8n, 8n, 3) IN ReLU ReflectPad(1) Conv(8n, 8n, 3) IN; three times Deconv(c, c/2, 3, stride 2,
/// padding 1, output padding 1); ReflectPad(3) Conv(n, out, 7). IN ReLU follows every convolution outside the blocks
/// but the last, whose output is returned as it is: callers apply tanh. IN has no learned scale and shift (epsilon
/// 1e-5).
/// All convolutions have a bias, as the published networks do, although IN removes it again: in 16, out 3, n 64 and six
/// blocks make the 31,475,267 parameters that are known of it. Weights start as N(0, 0.02²), biases at 0.
/// Sources: Johnson et al., ECCV 2016; Wang et al., CVPR 2018 (the global generator).
#pragma once

#include <torch/torch.h>
#include <vector>

namespace bodyloom {

struct ResidualGeneratorOptions {
  int in = 0, out = 0;
  int width = 64;  ///< n
  int blocks = 6;
  int passed = 0;  ///< channels that the last convolution sees beside the finest map, given to it past all others: not
                   ///< in the sources
  /// 3, or 4 (Deconv(c, c/2, 4, stride 2, padding 1)): every pixel then meets four taps, where with 3 it is one, two or
  /// four by turns, which shows as a grain of every other pixel. Not in the sources.
  int up_kernel = 3;
};

/// Every side of the input is a multiple of this.
inline constexpr int kResidualGeneratorMultiple = 8;

struct ResidualGeneratorImpl : torch::nn::Module {
  explicit ResidualGeneratorImpl(const ResidualGeneratorOptions& options);
  /// B×in×H×W → B×out×H×W, linear. H and W are multiples of 8 and at least 16; std::invalid_argument otherwise.
  /// `passed`: B×options.passed×H×W; undefined where that is 0.
  torch::Tensor forward(torch::Tensor x, const torch::Tensor& passed = {});

  ResidualGeneratorOptions options;
  torch::nn::Conv2d first{nullptr}, last{nullptr};
  std::vector<torch::nn::Conv2d> down;         ///< down0, down1, down2
  std::vector<torch::nn::Conv2d> blocks;       ///< block0a, block0b, block1a, …
  std::vector<torch::nn::ConvTranspose2d> up;  ///< up0, up1, up2
};
TORCH_MODULE(ResidualGenerator);

// A U-Net that completes maps: pooling down, bilinear up. Internal: includes LibTorch.
//
// Widths w_0 … w_L: at level l < L two convolutions to w_l, then 2×2 max-pooling; two convolutions to w_L at the
// bottom; for l = L−1 … 0 bilinear enlargement by 2, the map of level l beside it (the enlarged channels first), two
// convolutions to w_l. A convolution is Conv 3×3 IN ReLU, without bias, which IN would remove. A last 3×3 convolution
// (with bias) sees the finest map and, beside it, the network's own input: IN takes every map's mean away, and with it
// how bright a person's clothes are.
// Source: Ronneberger et al., MICCAI 2015; Sarkar et al., "Neural Re-Rendering of Humans from a Single Image", ECCV
// 2020, Section 3.2, which gives levels, pooling and enlargement but neither widths nor norms nor what is passed by.

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
