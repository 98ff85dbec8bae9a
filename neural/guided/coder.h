// SPDX-License-Identifier: Apache-2.0
/// Encoder and decoder that the networks of the pose-guided renderer are built from. Internal: includes LibTorch.
///
/// Encoder: C-BLK(in, w_0), C-BLK(w_0, w_1), …; its features by level, level l with w_l channels at 1/2^(l+1) of the
/// sides. SkipDecoder: D-BLK from the code at the deepest level upwards, at each level above it beside the encoder's
/// features of that size, then a 3×3 convolution that also sees the encoder's input; result linear. Blocks:
/// neural/networks/blocks.h.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "bodyloom/neural/networks/blocks.h"

namespace bodyloom {

struct EncoderImpl : torch::nn::Module {
  EncoderImpl(int in, const std::vector<int>& widths);
  /// B×in×H×W, sides multiples of 2^levels and H·W / 4^levels at least 2 → features, finest first.
  std::vector<torch::Tensor> forward(torch::Tensor x);

  std::vector<ConvBlock> blocks;
};
TORCH_MODULE(Encoder);

struct SkipDecoderImpl : torch::nn::Module {
  /// `code`: channels of what is handed in at the deepest level; `input`: of the encoder's input.
  SkipDecoderImpl(int code, const std::vector<int>& widths, int input, int out);
  /// `input` and `features`: of the encoder that is skipped over; its deepest features are not used (they are in the
  /// code).
  torch::Tensor forward(torch::Tensor code, const torch::Tensor& input, const std::vector<torch::Tensor>& features);

  std::vector<DeconvBlock> blocks;  ///< finest first
  torch::nn::Conv2d head{nullptr};
};
TORCH_MODULE(SkipDecoder);

/// Cells of the deepest level that a cropped picture covers, in those of the whole window.
struct CodeBox {
  int64_t x = 0, y = 0, width = 0, height = 0;
};

/// The box of B×C×h×w.
torch::Tensor Cropped(const torch::Tensor& map, const CodeBox& box);

}  // namespace bodyloom
