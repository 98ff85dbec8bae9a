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

}  // namespace bodyloom
