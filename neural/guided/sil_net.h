// SPDX-License-Identifier: Apache-2.0
/// SilNet: the person's silhouette in another pose. Internal: includes LibTorch.
///
/// Two encoders, of the source triplet {P, S, G} and of the target's pose map; their deepest features side by side are
/// decoded, with the target's features skipped over at every level. Yoon et al., CVPR 2021, Fig. 4.
#pragma once

#include <torch/torch.h>

#include "bodyloom/neural/guided/coder.h"
#include "bodyloom/neural/guided/guided_config.h"

namespace bodyloom {

struct SilNetImpl : torch::nn::Module {
  explicit SilNetImpl(const GuidedConfig& config);
  /// B×(4 + label channels)×H×W → the source's code, at the deepest level.
  torch::Tensor EncodeSource(const torch::Tensor& triplet);
  /// Code (of the same size as the target's deepest features), B×3 pose map and, with `contour_hints`, what is known of
  /// the clothes on the target's body, B×(label channels + 2) (else undefined) → B×1 logits.
  torch::Tensor forward(const torch::Tensor& source_code, const torch::Tensor& pose, const torch::Tensor& seen);

  bool from_body = false;  ///< the target's input ends with the bare body, 0 or 1
  Encoder source_encoder{nullptr}, target_encoder{nullptr};
  SkipDecoder decoder{nullptr};
};
TORCH_MODULE(SilNet);

}  // namespace bodyloom
