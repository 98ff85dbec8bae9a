// SPDX-License-Identifier: Apache-2.0
/// Discriminators of overlapping patches. Internal: includes LibTorch.
///
/// One scale, PatchGAN of n_layers = n and ndf channels, all kernels 4×4:
///   Conv(in, ndf, stride 2) LReLU; n−1 times Conv(c, min(2c, 8 ndf), stride 2) IN LReLU;
///   Conv(c, min(2c, 8 ndf), stride 1) IN LReLU; Conv(c, 1, stride 1)
/// The receptive field for n = 3 is 70×70 pixels (16, 34, 70, 142 for n = 1 … 4). Sources: Isola et al., CVPR 2017
/// (padding 1); Wang et al., CVPR 2018 (several scales; padding 2, and 3×3 averages of stride 2 between the scales,
/// padded pixels not counted). Weights start as N(0, 0.02²), biases at 0; convolutions before IN have no bias, which IN
/// would remove.
/// All return logits (no sigmoid): see neural/losses/image_losses.h.
#pragma once

#include <torch/torch.h>

#include <vector>

namespace bodyloom {

struct PatchDiscriminatorOptions {
  int in = 0;        ///< channels of condition and image together
  int ndf = 64;      ///< channels of the first layer
  int n_layers = 3;  ///< layers of stride 2
  int padding = 1;   ///< 1 as in Isola et al., 2 as in Wang et al.
};

struct PatchDiscriminatorImpl : torch::nn::Module {
  explicit PatchDiscriminatorImpl(const PatchDiscriminatorOptions& options);
  /// B×in×H×W → B×1×h×w. With padding 1 and n_layers 3: h = H/8 − 2; H and W at least 32.
  torch::Tensor forward(torch::Tensor x);

  PatchDiscriminatorOptions options;
  std::vector<torch::nn::Conv2d> layers;
};
TORCH_MODULE(PatchDiscriminator);

struct MultiScaleDiscriminatorImpl : torch::nn::Module {
  explicit MultiScaleDiscriminatorImpl(const PatchDiscriminatorOptions& options, int num_scales = 3);
  /// Logits of each scale, the finest first.
  std::vector<torch::Tensor> forward(torch::Tensor x);

  std::vector<PatchDiscriminator> scales;
};
TORCH_MODULE(MultiScaleDiscriminator);

}  // namespace bodyloom
