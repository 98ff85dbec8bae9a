// SPDX-License-Identifier: Apache-2.0
#include "neural/photo/photo_card.h"

#include "neural/networks/architecture_card.h"
#include "neural/photo/photo_model.h"

namespace bodyloom {

std::string PhotoCard(const PhotoConfig& config) {
  PhotoModel model(config);
  MultiScaleDiscriminator discriminator = PhotoDiscriminator(config);
  const int64_t side = config.profile.image_size, texels = config.profile.texture_size;
  std::string text;
  const auto add = [&](const char* title, auto& network, const std::vector<int64_t>& input) {
    text += std::string(text.empty() ? "" : "\n") + title + "\n" + ArchitectureCard(network, input);
  };
  if (config.Completes()) {
    add("FeatureNet f, once a photo", model->feature_net, {1, model->feature_net->options.in, texels, texels});
  }
  add("RenderNet g, a frame", model->render_net, {1, model->render_net->options.in, side, side});
  add("discriminators D, in training", discriminator, {1, discriminator->scales[0]->options.in, side, side});
  return text;
}

}  // namespace bodyloom
