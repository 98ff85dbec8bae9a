// SPDX-License-Identifier: Apache-2.0
/// GarNet: the garment labels in another pose, completed from what is known of them. Internal: includes LibTorch.
///
/// One encoder sees the triplets {P, S, G} of the source and {P^t, S^t, G̃^t} of the target; their deepest features
/// side by side are decoded, with the target's features skipped over at every level. Yoon et al., CVPR 2021, Fig. 5.
#pragma once

#include <torch/torch.h>

#include "bodyloom/neural/guided/coder.h"
#include "bodyloom/neural/guided/guided_config.h"

namespace bodyloom {

struct GarNetImpl : torch::nn::Module {
  explicit GarNetImpl(const GuidedConfig& config);
  /// B×(4 + label channels)×H×W → the source's code, at the deepest level.
  torch::Tensor EncodeSource(const torch::Tensor& triplet);
  /// Code (of the same size as the target's deepest features) and the target's triplet → B×7 logits.
  torch::Tensor forward(const torch::Tensor& source_code, const torch::Tensor& triplet);

  Encoder encoder{nullptr};
  SkipDecoder decoder{nullptr};
};
TORCH_MODULE(GarNet);

}  // namespace bodyloom
