// SPDX-License-Identifier: Apache-2.0
#include "neural/guided/sil_net.h"

namespace bodyloom {

SilNetImpl::SilNetImpl(const GuidedConfig& config) {
  const std::vector<int>& widths = config.profile.shape_widths;
  source_encoder = register_module("source_encoder", Encoder(4 + config.LabelChannels(), widths));
  target_encoder = register_module("target_encoder", Encoder(3, widths));
  decoder = register_module("decoder", SkipDecoder(2 * widths.back(), widths, 3, 1));
}

torch::Tensor SilNetImpl::EncodeSource(const torch::Tensor& triplet) { return source_encoder(triplet).back(); }

torch::Tensor SilNetImpl::forward(const torch::Tensor& source_code, const torch::Tensor& pose) {
  const std::vector<torch::Tensor> features = target_encoder(pose);
  return decoder(torch::cat({features.back(), source_code}, 1), pose, features);
}

}  // namespace bodyloom
