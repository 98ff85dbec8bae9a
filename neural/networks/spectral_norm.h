// SPDX-License-Identifier: Apache-2.0
/// A convolution whose weights are divided by their largest singular value. Internal: includes LibTorch.
///
/// With the weights as a matrix W (channels out × the rest) and unit vectors u, v that a step of power iteration turns
/// before every forward pass of training, v ← Wᵀu/|Wᵀu|, u ← W v/|W v|:  σ = uᵀ W v,  the convolution uses W/σ.
/// u and v count as constants in the gradient. They are buffers ("u", "v"), so that checkpoints hold them; in
/// evaluation they stay as they are. Source: Miyato et al., "Spectral Normalization for Generative Adversarial
/// Networks", ICLR 2018.
#pragma once

#include <torch/torch.h>

namespace bodyloom {

/// σ for a weight of any shape and vectors of unit length; differentiable in the weight.
torch::Tensor SpectralScale(const torch::Tensor& weight, const torch::Tensor& u, const torch::Tensor& v);

/// Square, stride 1, same size out. Kaiming weights (neural/networks/blocks.h). Without `normalise` a plain one.
struct SpectralConvImpl : torch::nn::Module {
  SpectralConvImpl(int from, int to, int kernel, bool bias, bool normalise);
  torch::Tensor forward(const torch::Tensor& x);
  /// The step of power iteration that forward makes in training.
  void Iterate();

  torch::nn::Conv2d conv{nullptr};
  torch::Tensor u, v;  ///< undefined without `normalise`
};
TORCH_MODULE(SpectralConv);

}  // namespace bodyloom
