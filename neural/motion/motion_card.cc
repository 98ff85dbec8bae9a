// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/motion/motion_card.h"

#include "bodyloom/neural/motion/motion_model.h"
#include "bodyloom/neural/networks/architecture_card.h"
#include "bodyloom/neural/networks/patch_discriminator.h"

namespace bodyloom {

std::string MotionCard(const MotionConfig& config) {
  MotionModel model(config);
  PatchDiscriminator discriminator(
      PatchDiscriminatorOptions{3 + config.num_labels, config.profile.discriminator_width});
  const int64_t side = config.profile.image_size, uv = config.profile.uv_size;
  std::string text;
  const auto add = [&](const char* title, auto& network, const std::vector<int64_t>& input) {
    text += std::string(text.empty() ? "" : "\n") + title + "\n" + ArchitectureCard(network, input);
  };
  if (config.motion && config.descriptor == MotionDescriptor::kSurface) {
    add("motion encoder E, a frame's UV maps", model->encoder, {1, config.motion_channels, uv, uv});
  } else if (config.motion) {
    add("motion encoder E, a frame's picture and those before it", model->encoder,
        {1, config.motion_channels, side, side});
  }
  if (config.shape) {
    add("shape decoder D_s", model->shape_decoder, {1, model->shape_decoder->options.in, side, side});
  }
  add("appearance decoder D_a", model->appearance_decoder, {1, model->appearance_decoder->options.in, side, side});
  if (config.texture) {
    const torch::NoGradGuard no_grad;
    const torch::Tensor uv = torch::zeros({1, 2, side, side}), body = torch::ones({1, 1, side, side});
    text += "\nlearned texture, with what classes and colour take from it\n" +
            ArchitectureCard(*model->texture, {uv.sizes().vec(), body.sizes().vec()}, [&] {
              const torch::Tensor texel = model->texture(uv, body);
              if (config.shape) model->texture->labels_of_texel(texel);
              model->texture->colour_of_texel(texel);
            });
  }
  add("discriminator D*, in training", discriminator, {1, 3 + config.num_labels, side, side});
  return text;
}

}  // namespace bodyloom
