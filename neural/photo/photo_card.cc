// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/photo/photo_card.h"

#include "bodyloom/neural/networks/architecture_card.h"
#include "bodyloom/neural/photo/photo_model.h"

namespace bodyloom {

std::string PhotoCard(const PhotoConfig& config) {
  PhotoModel model(config);
  MultiScaleDiscriminator discriminator = PhotoDiscriminator(config);
  const int64_t side = config.profile.image_size, texels = config.profile.texture_size;
  std::string text;
  const auto add = [&](const char* title, const std::string& card) {
    text += std::string(text.empty() ? "" : "\n") + title + "\n" + card;
  };
  if (config.Completes()) {
    add("FeatureNet f, once a photo",
        ArchitectureCard(model->feature_net, {1, model->feature_net->options.in, texels, texels}));
  }
  const ResidualGeneratorOptions& render = model->render_net->options;
  std::vector<std::vector<int64_t>> inputs = {{1, render.in, side, side}};
  if (render.passed > 0) inputs.push_back({1, render.passed, side, side});
  add("RenderNet g, a frame", ArchitectureCard(*model->render_net, inputs, [&] {
        const torch::NoGradGuard no_grad;
        const torch::Tensor passed = render.passed > 0 ? torch::zeros({0, render.passed, side, side}) : torch::Tensor();
        model->render_net(torch::zeros({0, render.in, side, side}), passed);
      }));
  add("discriminators D, in training",
      ArchitectureCard(discriminator, {1, discriminator->scales[0]->options.in, side, side}));
  return text;
}

}  // namespace bodyloom
