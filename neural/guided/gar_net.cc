// SPDX-License-Identifier: Apache-2.0
#include "neural/guided/gar_net.h"

#include "neural/people/photo_frame.h"

namespace bodyloom {

GarNetImpl::GarNetImpl(const GuidedConfig& config) {
  const std::vector<int>& widths = config.profile.shape_widths;
  const int input = 4 + config.LabelChannels();
  encoder = register_module("encoder", Encoder(input, widths));
  decoder = register_module("decoder", SkipDecoder(2 * widths.back(), widths, input, kPhotoLabels));
}

torch::Tensor GarNetImpl::EncodeSource(const torch::Tensor& triplet) { return encoder(triplet).back(); }

torch::Tensor GarNetImpl::forward(const torch::Tensor& source_code, const torch::Tensor& triplet) {
  const std::vector<torch::Tensor> features = encoder(triplet);
  return decoder(torch::cat({features.back(), source_code}, 1), triplet, features);
}

}  // namespace bodyloom
