// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/guided/sil_net.h"

namespace bodyloom {

using torch::Tensor;

SilNetImpl::SilNetImpl(const GuidedConfig& config) {
  const std::vector<int>& widths = config.profile.shape_widths;
  from_body = config.profile.start_from_body;
  const int input = 3 + (config.profile.contour_hints ? config.LabelChannels() + 2 : 0) + (from_body ? 1 : 0);
  source_encoder = register_module("source_encoder", Encoder(4 + config.LabelChannels(), widths));
  target_encoder = register_module("target_encoder", Encoder(input, widths));
  decoder = register_module("decoder", SkipDecoder(2 * widths.back(), widths, input, 1));
  if (!from_body) return;
  // A new network predicts what is likely: 4 inside, −2 outside. That is the body as far as clothes stood off the
  // source, or else (or where nobody knows) the bare body, a pixel wider and soft.
  const torch::NoGradGuard no_grad;
  Tensor weight = decoder->head->weight[0];
  const int64_t channels = weight.size(0);
  if (config.profile.contour_hints && config.source_silhouette) {
    weight[channels - 2][1][1] += 6;
  } else {
    weight[channels - 1] += 6.0 / 9;
  }
  decoder->head->bias -= 2;
}

Tensor SilNetImpl::EncodeSource(const Tensor& triplet) { return source_encoder(triplet).back(); }

Tensor SilNetImpl::forward(const Tensor& source_code, const Tensor& pose, const Tensor& seen) {
  std::vector<Tensor> inputs = {pose};
  if (seen.defined()) inputs.push_back(seen);
  if (from_body) inputs.push_back((pose.amax(1, /*keepdim=*/true) > 0).to(pose.scalar_type()));
  const Tensor input = torch::cat(inputs, 1);
  const std::vector<Tensor> features = target_encoder(input);
  return decoder(torch::cat({features.back(), source_code}, 1), input, features);
}

}  // namespace bodyloom
