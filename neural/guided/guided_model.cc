// SPDX-License-Identifier: Apache-2.0
#include "neural/guided/guided_model.h"

#include "neural/losses/image_losses.h"
#include "neural/networks/uv_sampler.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

using torch::Tensor;

GuidedModelImpl::GuidedModelImpl(const GuidedConfig& guided_config) : config(guided_config) {
  if (config.silhouettes) sil = register_module("sil", SilNet(config));
  if (config.garments) gar = register_module("gar", GarNet(config));
  render = register_module("render", RenderNet(config));
}

Tensor GuidedModelImpl::LabelMap(const Tensor& classes) const {
  if (!config.profile.one_hot_labels) return classes / (kPhotoLabels - 1);
  return OneHot(classes.squeeze(1).to(torch::kLong), kPhotoLabels).to(classes.scalar_type());
}

Tensor GuidedModelImpl::SourceLabelMap(const Tensor& classes) const {
  const Tensor labels = LabelMap(classes);
  return config.source_labels ? labels : torch::zeros_like(labels);
}

Tensor GuidedModelImpl::OfSourceSilhouette(const Tensor& map) const {
  return config.source_silhouette ? map : torch::zeros_like(map);
}

GuidedSource GuidedModelImpl::EncodeSource(const GuidedTensors& source) {
  const Tensor labels = SourceLabelMap(source.classes), silhouette = OfSourceSilhouette(source.silhouette);
  const Tensor shape = torch::cat({source.pose, silhouette, labels}, 1);
  GuidedSource codes;
  if (config.silhouettes) codes.sil_code = sil->EncodeSource(shape);
  if (config.garments) codes.gar_code = gar->EncodeSource(shape);
  codes.render_code = render->EncodeSource(torch::cat({source.image, silhouette, labels}, 1));
  return codes;
}

Tensor GuidedModelImpl::Silhouette(const GuidedSource& source, const Tensor& pose, const GuidedPseudo& pseudo,
                                   const CodeBox& box) {
  const Tensor seen =
      config.profile.contour_hints
          ? torch::cat({SourceLabelMap(pseudo.contour_classes), OfSourceSilhouette(pseudo.clothes_offset)}, 1)
          : Tensor();
  return sil(Cropped(source.sil_code, box), pose, seen);
}

Tensor GuidedModelImpl::Labels(const GuidedSource& source, const Tensor& pose, const Tensor& silhouette,
                               const Tensor& pseudo_classes, const CodeBox& box) {
  const Tensor known = silhouette.defined() ? silhouette : torch::zeros_like(pseudo_classes);
  return gar(Cropped(source.gar_code, box), torch::cat({pose, known, SourceLabelMap(pseudo_classes)}, 1));
}

std::pair<Tensor, Tensor> GuidedModelImpl::Render(const Tensor& code, const Tensor& pose, const Tensor& silhouette,
                                                  const Tensor& classes, const GuidedPseudo& pseudo,
                                                  const CodeBox& box) {
  const Tensor none = torch::zeros_like(pseudo.silhouette);
  // Without GarNet no labels are known, not even the background's.
  const Tensor labels = config.garments ? LabelMap(classes) : none.expand({-1, config.LabelChannels(), -1, -1});
  std::vector<Tensor> guide = {labels, config.silhouettes ? silhouette : none};
  if (config.PoseForRender()) guide.push_back(pose);
  Tensor seen = torch::cat({pseudo.image, OfSourceSilhouette(pseudo.silhouette)}, 1), shown = pseudo.image;
  // Extending colours requires the known mask, and garments if colours must stay within them.
  if (config.profile.fill_colours && config.source_silhouette) {
    shown = CarryColours(pseudo.image, pseudo.silhouette, pseudo.classes,
                         config.garments && config.source_labels ? classes : Tensor());
  }
  if (!config.pseudo_image) seen = torch::zeros_like(seen), shown = torch::zeros_like(shown);
  const Tensor colours = render(code.defined() ? Cropped(code, box) : code, torch::cat(guide, 1), seen, shown);
  const Tensor mask = colours.size(1) == 4 ? torch::sigmoid(colours.slice(1, 3, 4)) : silhouette;
  return {torch::sigmoid(colours.slice(1, 0, 3)) * mask, mask};
}

GuidedResult GuidedModelImpl::forward(const GuidedSource& source, const Tensor& pose, const GuidedPseudo& pseudo,
                                      const CodeBox& box) {
  const torch::NoGradGuard no_grad;
  GuidedResult result;
  Tensor silhouette;
  if (config.silhouettes) silhouette = torch::sigmoid(Silhouette(source, pose, pseudo, box));
  result.classes = torch::zeros_like(pseudo.classes);
  if (config.garments) {
    result.label_logits = Labels(source, pose, silhouette, pseudo.classes, box);
    result.classes = result.label_logits.argmax(1, true).to(torch::kFloat);
    if (!silhouette.defined()) silhouette = 1 - torch::softmax(result.label_logits, 1).slice(1, 0, 1);
  }
  std::tie(result.image, result.silhouette) =
      Render(source.render_code.mean, pose, silhouette, result.classes, pseudo, box);
  return result;
}

PatchDiscriminator GuidedDiscriminator(const GuidedConfig& config) {
  return PatchDiscriminator(PatchDiscriminatorOptions{3 + config.LabelChannels(), config.profile.discriminator_width});
}

namespace {

constexpr int kLevels = 5;  ///< reaches about 32 pixels outwards

}  // namespace

Tensor CarryColours(const Tensor& image, const Tensor& known, const Tensor& known_classes, const Tensor& classes) {
  const torch::NoGradGuard no_grad;
  Tensor result = PullPush(image, known, kLevels);
  if (!classes.defined()) return result;
  for (int k = 1; k < kPhotoLabels; ++k) {
    const Tensor here = classes == k;
    const Tensor mask = known * (known_classes == k);
    const Tensor somewhere = mask.amax({1, 2, 3}, /*keepdim=*/true) > 0;
    const Tensor takes = here & somewhere;
    if (!takes.any().item<bool>()) continue;
    result = torch::where(takes, PullPush(image, mask, kLevels), result);
  }
  return result;
}

}  // namespace bodyloom
