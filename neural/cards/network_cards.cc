// SPDX-License-Identifier: Apache-2.0
#include "neural/cards/network_cards.h"

#include "neural/guided/guided_model.h"
#include "neural/motion/motion_model.h"
#include "neural/networks/architecture_card.h"
#include "neural/networks/patch_discriminator.h"
#include "neural/photo/photo_model.h"

namespace bodyloom {

std::string GuidedCard(const GuidedConfig& config) {
  const torch::NoGradGuard no_grad;
  GuidedModel model(config);
  const int64_t side = config.profile.image_size, cells = side / config.Multiple(),
                triplet = 4 + config.LabelChannels();
  const int64_t guide = config.LabelChannels() + 1 + (config.PoseForRender() ? 3 : 0);
  const int64_t hints = config.profile.contour_hints ? config.LabelChannels() + 2 : 0;
  using Shapes = std::vector<std::pair<int64_t, int64_t>>;
  std::string text;
  const auto pixels = [&](int64_t channels) { return torch::zeros({0, channels, side, side}); };
  const auto add = [&](const std::string& title, const torch::nn::Module& network, const Shapes& inputs,
                       const auto& run, const std::function<void()>& encode) {
    std::vector<std::vector<int64_t>> shapes;
    std::vector<torch::Tensor> nothing;
    for (const auto& [channels, of_side] : inputs) {
      shapes.push_back({1, channels, of_side, of_side});
      nothing.push_back(torch::zeros({0, channels, of_side, of_side}));
    }
    text += (text.empty() ? "" : "\n") + title + "\n" + ArchitectureCard(network, shapes, [&] { run(nothing); });
    if (encode) text += "once a photo    " + std::to_string(CountMultiplyAdds(encode)) + " multiply-adds\n";
  };
  using Tensors = std::vector<torch::Tensor>;
  const int64_t shape_code = config.profile.shape_widths.back();
  if (config.silhouettes) {
    add(
        "SilNet, a frame: the source's code, the pose map" +
            std::string(hints > 0 ? ", what is known of the clothes" : ""),
        *model->sil,
        hints > 0 ? Shapes{{shape_code, cells}, {3, side}, {hints, side}} : Shapes{{shape_code, cells}, {3, side}},
        [&](const Tensors& in) { model->sil(in[0], in[1], hints > 0 ? in[2] : torch::Tensor()); },
        [&] { model->sil->EncodeSource(pixels(triplet)); });
  }
  if (config.garments) {
    add(
        "GarNet, a frame: the source's code, the target's triplet", *model->gar, {{shape_code, cells}, {triplet, side}},
        [&](const Tensors& in) { model->gar(in[0], in[1]); }, [&] { model->gar->EncodeSource(pixels(triplet)); });
  }
  add(
      "RenderNet, a frame: the source's code, labels and silhouette, the pseudo image and its silhouette, the "
      "colours shown to the last convolution",
      *model->render, {{config.profile.latent, cells}, {guide, side}, {4, side}, {3, side}},
      [&](const Tensors& in) { model->render(in[0], in[1], in[2], in[3]); },
      [&] { model->render->EncodeSource(pixels(triplet)); });
  PatchDiscriminator discriminator = GuidedDiscriminator(config);
  const int64_t judged = discriminator->options.in;
  add(
      "discriminator D, in training", *discriminator, {{judged, side}},
      [&](const Tensors& in) { discriminator(in[0]); }, nullptr);
  return text;
}

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
    add("motion encoder E, a frame's image and those before it", model->encoder,
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
