// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/guided/gar_net.h"

#include "bodyloom/neural/people/photo_frame.h"

namespace bodyloom {

GarNetImpl::GarNetImpl(const GuidedConfig& config) {
  const std::vector<int>& widths = config.profile.shape_widths;
  const int input = 4 + config.LabelChannels();
  encoder = register_module("encoder", Encoder(input, widths));
  decoder = register_module("decoder", SkipDecoder(2 * widths.back(), widths, input, kPhotoLabels));
  if (!config.profile.one_hot_labels) return;
  // A new network repeats the labels that it is given; label 0 stands for those that are not known.
  const torch::NoGradGuard no_grad;
  const int64_t first_label = decoder->head->weight.size(1) - kPhotoLabels;
  for (int64_t k = 1; k < kPhotoLabels; ++k) decoder->head->weight[k][first_label + k][1][1] += 4;
}

torch::Tensor GarNetImpl::EncodeSource(const torch::Tensor& triplet) { return encoder(triplet).back(); }

torch::Tensor GarNetImpl::forward(const torch::Tensor& source_code, const torch::Tensor& triplet) {
  const std::vector<torch::Tensor> features = encoder(triplet);
  return decoder(torch::cat({features.back(), source_code}, 1), triplet, features);
}

}  // namespace bodyloom
