// SPDX-License-Identifier: Apache-2.0
/// SphereFace: face features by the published twenty-layer network. Internal: includes LibTorch.
///
/// 3×112×96 → 512 numbers. Stages s = 1 … 4 of 64, 128, 256, 512 channels: Conv(3×3, stride 2) PReLU, then 1, 2, 4 and
/// 1 residual units x + PReLU Conv PReLU Conv x (3×3, stride 1); fully connected 512·7·6 → 512. PReLU has a slope per
/// channel; no norms. Parameters are named as in the published PyTorch version, "conv2_3.weight", "relu2_3.weight",
/// "fc5.weight", whose classifier ("fc6.weight") is not needed.
/// Source: Liu et al., "SphereFace: Deep Hypersphere Embedding for Face Recognition", CVPR 2017, Table 2.
///
/// The trained weights are not part of this project; there is no random-feature substitute, as it would be useless for
/// faces.
#pragma once

#include <torch/torch.h>

#include <string>
#include <vector>

#include "neural/networks/load_weights.h"

namespace bodyloom {

inline constexpr int kFaceHeight = 112, kFaceWidth = 96;

/// Parameters never require gradients; gradients flow to the input.
struct SphereFaceImpl : torch::nn::Module {
  SphereFaceImpl();
  /// Loads trained weights. Throws as LoadWeights.
  LoadWeightsReport Load(const NamedWeights& weights, const std::string& source);
  /// B×3×112×96 RGB in [0, 1] → B×512. The network's own input is BGR, (255 x − 127.5)/128.
  torch::Tensor forward(const torch::Tensor& face);

 private:
  struct Unit {
    torch::nn::Conv2d conv{nullptr};
    torch::nn::PReLU relu{nullptr};
    torch::Tensor operator()(const torch::Tensor& x) { return relu->forward(conv->forward(x)); }
  };
  std::vector<std::vector<Unit>> stages_;
  torch::nn::Linear fc5_{nullptr};
};
TORCH_MODULE(SphereFace);

}  // namespace bodyloom
