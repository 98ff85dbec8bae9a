// SPDX-License-Identifier: Apache-2.0
/// Generators: a residual network from feature maps to images, and a U-Net that completes maps. Internal: includes
/// LibTorch.
///
/// ReflectPad(3) Conv(in, n, 7); three times Conv(c, 2c, 3, stride 2, padding 1); residual blocks x + F(x), F =
/// ReflectPad(1) Conv(8n, 8n, 3) IN ReLU ReflectPad(1) Conv(8n, 8n, 3) IN; three times Deconv(c, c/2, 3, stride 2,
/// padding 1, output padding 1); ReflectPad(3) Conv(n, out, 7). IN ReLU follows every convolution outside the blocks
/// except the last, whose output is linear: callers apply tanh. IN has no learned scale and shift (epsilon 1e-5).
/// All convolutions have a bias, as in the published networks, although IN removes it: with in 16, out 3, n 64 and six
/// blocks this gives the published 31,475,267 parameters. Weights start as N(0, 0.02²), biases at 0.
/// Sources: Johnson et al., ECCV 2016; Wang et al., CVPR 2018 (the global generator).
#pragma once

#include <torch/torch.h>
#include <vector>

namespace bodyloom {

struct ResidualGeneratorOptions {
  int in = 0, out = 0;
  int width = 64;  ///< n
  int blocks = 6;
  int passed = 0;  ///< channels passed directly to the last convolution, beside the finest map: not
                   ///< in the sources
  /// 3, or 4 (Deconv(c, c/2, 4, stride 2, padding 1)): every pixel then has four taps, whereas with 3 it alternates
  /// between one, two and four, which is visible as a pattern of period two. Not in the sources.
  int up_kernel = 3;
};

/// Sides of the input must be multiples of this.
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

// A U-Net that completes maps, with max-pooling and bilinear upsampling.
//
// Widths w_0 … w_L: at level l < L two convolutions to w_l, then 2×2 max-pooling; two convolutions to w_L at the
// bottom; for l = L−1 … 0 bilinear upsampling by 2, concatenation with the map of level l (upsampled channels first),
// two convolutions to w_l. A convolution is Conv 3×3 IN ReLU, without bias, which IN would remove. A last 3×3
// convolution (with bias) has the finest map and the network's input as its inputs, because IN removes every map's
// mean, and with it the brightness of clothes.
// Source: Ronneberger et al., MICCAI 2015; Sarkar et al., "Neural Re-Rendering of Humans from a Single Image", ECCV
// 2020, Section 3.2, which gives levels, pooling and upsampling but neither widths nor norms nor skip connections.

struct FeatureUNetOptions {
  int in = 0, out = 0;
  std::vector<int> widths;  ///< w_0 … w_L, at least two
};

struct FeatureUNetImpl : torch::nn::Module {
  explicit FeatureUNetImpl(const FeatureUNetOptions& options);
  /// B×in×H×W → B×out×H×W, linear. H and W are multiples of 2^L, and at least 2^(L+1); std::invalid_argument otherwise.
  torch::Tensor forward(torch::Tensor x);

  FeatureUNetOptions options;
  std::vector<torch::nn::Conv2d> encoder;  ///< two per level, the bottom's last: encoder0a, encoder0b, …
  std::vector<torch::nn::Conv2d> decoder;  ///< two per level, finest first: decoder0a, …
  torch::nn::Conv2d last{nullptr};
};
TORCH_MODULE(FeatureUNet);

}  // namespace bodyloom
