// SPDX-License-Identifier: Apache-2.0
/// Normalisation with scale and shift predicted from maps, and a residual block based on it. Internal: includes
/// LibTorch.
///
/// With IN, instance normalisation without parameters, and for each map m_i (resized to the size of x, bilinear):
///   h_i = ReLU(Conv3(m_i, hidden)),   (γ_i, β_i) = Conv3(h_i, 2C)
///   y_0 = IN(x),   y_i = (1 + γ_i) y_{i−1} + β_i
/// The maps act in sequence, so that later ones can override earlier ones. γ is initialised with 0 and β with Kaiming
/// weights: an untrained network normalises and already depends on its maps.
///   ModulatedBlock: y = Conv3(LReLU(mod(x))), z = Conv3(LReLU(mod(y))), result z + x, x through a 1×1 convolution
///   if the number of channels changes.
/// Based on Park et al., "Semantic Image Synthesis with Spatially-Adaptive Normalization", CVPR 2019, and, for several
/// maps in sequence, Mallya et al., "World-Consistent Video-to-Video Synthesis", ECCV 2020.
#pragma once

#include <torch/torch.h>
#include <vector>

namespace bodyloom {

// Convolution with spectral normalisation: weights are divided by their largest singular value.
//
// With the weights as a matrix W (channels out × the rest) and unit vectors u, v, updated by a step of power iteration
// before every forward pass of training,
//   v ← Wᵀu/|Wᵀu|,   u ← W v/|W v|,   σ = uᵀ W v,
// the convolution uses W/σ. u and v are constants in the gradient. They are buffers ("u", "v"), stored in checkpoints;
// in evaluation they are not updated. Source: Miyato et al., "Spectral Normalization for Generative Adversarial
// Networks", ICLR 2018.

/// Computes σ for a weight of any shape and unit vectors; differentiable in the weight.
torch::Tensor SpectralScale(const torch::Tensor& weight, const torch::Tensor& u, const torch::Tensor& v);

/// Square kernel, stride 1, same output size. Kaiming weights (neural/networks/blocks.h). Without `normalise` a plain
/// convolution.
struct SpectralConvImpl : torch::nn::Module {
  SpectralConvImpl(int from, int to, int kernel, bool bias, bool normalise);
  torch::Tensor forward(const torch::Tensor& x);
  /// Performs the step of power iteration of forward() in training.
  void Iterate();

  torch::nn::Conv2d conv{nullptr};
  torch::Tensor u, v;  ///< undefined without `normalise`
};
TORCH_MODULE(SpectralConv);

struct SpatialModulationImpl : torch::nn::Module {
  SpatialModulationImpl(int channels, const std::vector<int>& map_channels, int hidden);
  /// x: B×C×H×W with H·W at least 2; the number of maps is that of the constructor.
  torch::Tensor forward(const torch::Tensor& x, const std::vector<torch::Tensor>& maps);

  std::vector<torch::nn::Conv2d> first, second;  ///< one pair per map
};
TORCH_MODULE(SpatialModulation);

struct ModulatedBlockImpl : torch::nn::Module {
  ModulatedBlockImpl(int from, int to, const std::vector<int>& map_channels, int hidden, bool spectral_norm);
  torch::Tensor forward(const torch::Tensor& x, const std::vector<torch::Tensor>& maps);

  SpatialModulation modulation1{nullptr}, modulation2{nullptr};
  SpectralConv conv1{nullptr}, conv2{nullptr}, shortcut{nullptr};  ///< shortcut: only if the number of channels changes
};
TORCH_MODULE(ModulatedBlock);

}  // namespace bodyloom
