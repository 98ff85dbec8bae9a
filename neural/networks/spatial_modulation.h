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

#include "bodyloom/neural/networks/spectral_norm.h"

namespace bodyloom {

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
