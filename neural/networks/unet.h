// SPDX-License-Identifier: Apache-2.0
/// The U-Net used as motion encoder, shape decoder and appearance decoder. Internal: includes LibTorch.
///
/// Widths w_0 … w_{L−1}: encoder C-BLK(in, w_0), C-BLK(w_0, w_1), …; mirrored decoder D-BLK(c, w_l, w_{l−1}) for
/// l = L−1 … 0 (w_{−1} := w_0), where c = w_{L−1} at the deepest level and 2 w_l above it, because the encoder's map of
/// the same size is concatenated (decoder's channels first); then a 3×3 convolution for each head. The last D-BLK is
/// shared by all heads. The paper's figures of these networks give neither channels nor levels nor skips: the profiles
/// are this project's choice.
/// Heads are initialised as N(0, 0.02²) with bias 0, so that initial class probabilities are nearly uniform.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "neural/networks/blocks.h"

namespace bodyloom {

struct UNetOptions {
  int in = 0;               ///< channels of the input
  std::vector<int> out;     ///< channels of each head
  std::vector<int> widths;  ///< channels of the encoder's levels, finest first
  int decoder_min = 1;      ///< minimum channels of a decoder block
  NormOrder norm_order = NormOrder::kNormFirst;
};

struct UNetImpl : torch::nn::Module {
  explicit UNetImpl(const UNetOptions& options);
  /// B×in×H×W → for each head B×out×H×W, linear (no sigmoid, softmax or tanh). H and W must be multiples of
  /// 2^levels, and the deepest map must have at least two pixels for the normalisation; throws std::invalid_argument
  /// otherwise.
  std::vector<torch::Tensor> forward(torch::Tensor x);

  UNetOptions options;
  std::vector<ConvBlock> encoder;    ///< finest first; named encoder0, encoder1, …
  std::vector<DeconvBlock> decoder;  ///< finest first; named decoder0, decoder1, …
  std::vector<torch::nn::Conv2d> heads;
};
TORCH_MODULE(UNet);

}  // namespace bodyloom
