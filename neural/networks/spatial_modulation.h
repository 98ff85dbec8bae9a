// SPDX-License-Identifier: Apache-2.0
/// Normalisation whose scale and shift are painted by maps, and the residual block made of it. Internal: includes
/// LibTorch.
///
/// With IN, instance normalisation without parameters, and for each map m_i (brought to the size of x, bilinear):
///   h_i = ReLU(Conv3(m_i, hidden)),   (γ_i, β_i) = Conv3(h_i, 2C)
///   y_0 = IN(x),   y_i = (1 + γ_i) y_{i−1} + β_i
/// The maps act one after the other, so that a later one can overrule what an earlier one painted. γ starts at 0 and β
/// with Kaiming weights: a new network normalises, and already shows its maps.
///   ModulatedBlock: y = Conv3(LReLU(mod(x))), z = Conv3(LReLU(mod(y))), result z + x, x through a 1×1 convolution
///   where the channels change.
/// After the idea of Park et al., "Semantic Image Synthesis with Spatially-Adaptive Normalization", CVPR 2019, and, for
/// several maps in sequence, Mallya et al., "World-Consistent Video-to-Video Synthesis", ECCV 2020.
#pragma once

#include <torch/torch.h>
#include <vector>

namespace bodyloom {

// A convolution whose weights are divided by their largest singular value. Internal: includes LibTorch.
//
// With the weights as a matrix W (channels out × the rest) and unit vectors u, v that a step of power iteration turns
// before every forward pass of training, v ← Wᵀu/|Wᵀu|, u ← W v/|W v|:  σ = uᵀ W v,  the convolution uses W/σ.
// u and v count as constants in the gradient. They are buffers ("u", "v"), so that checkpoints hold them; in
// evaluation they stay as they are. Source: Miyato et al., "Spectral Normalization for Generative Adversarial
// Networks", ICLR 2018.

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

struct SpatialModulationImpl : torch::nn::Module {
  SpatialModulationImpl(int channels, const std::vector<int>& map_channels, int hidden);
  /// x: B×C×H×W with H·W at least 2; as many maps as at construction.
  torch::Tensor forward(const torch::Tensor& x, const std::vector<torch::Tensor>& maps);

  std::vector<torch::nn::Conv2d> first, second;  ///< a pair a map
};
TORCH_MODULE(SpatialModulation);

struct ModulatedBlockImpl : torch::nn::Module {
  ModulatedBlockImpl(int from, int to, const std::vector<int>& map_channels, int hidden, bool spectral_norm);
  torch::Tensor forward(const torch::Tensor& x, const std::vector<torch::Tensor>& maps);

  SpatialModulation modulation1{nullptr}, modulation2{nullptr};
  SpectralConv conv1{nullptr}, conv2{nullptr}, shortcut{nullptr};  ///< shortcut: only where the channels change
};
TORCH_MODULE(ModulatedBlock);

}  // namespace bodyloom
