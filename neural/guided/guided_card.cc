// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/guided/guided_card.h"

#include "bodyloom/neural/guided/guided_model.h"
#include "bodyloom/neural/networks/architecture_card.h"

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

}  // namespace bodyloom
