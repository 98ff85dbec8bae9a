// SPDX-License-Identifier: Apache-2.0
/// The three networks of the pose-guided renderer. Internal: includes LibTorch.
///
///   S^t = sigmoid SilNet(P^t | {P^s, S^s, G^s})
///   G^t = softmax GarNet(G̃^t | P^t, S^t, {P^s, S^s, G^s})
///   I^t = S^t · sigmoid RenderNet(Ĩ^t, S̃^t | S^t, G^t, {I^s, S^s, G^s})
/// Source: Yoon et al., "Pose-Guided Human Animation from a Single Image in the Wild", CVPR 2021, Section 3.1. P:
/// colours of body parts (render/texture/complete/body_part_map.h); S: silhouette; G: garment labels; tilde: pseudo
/// inputs, what is known of the target where it shows the bare body.
///
/// SilNet (guided_networks.h) has an encoder of the source and one of the target, GarNet (guided_networks.h) one for
/// both; RenderNet: guided_networks.h. Pictures of the source fill the whole window, those of the target may be cropped
/// to a box of code cells: then the source's codes are cropped with it.
#pragma once

#include <torch/torch.h>
#include <cstdint>
#include <vector>

#include "neural/guided/guided_config.h"
#include "neural/guided/guided_networks.h"
#include "neural/networks/patch_discriminator.h"

namespace bodyloom {

/// What is known of B pictures. Undefined where it is not.
struct GuidedTensors {
  torch::Tensor pose;        ///< B×3×H×W
  torch::Tensor silhouette;  ///< B×1×H×W
  torch::Tensor classes;     ///< B×1×H×W class numbers, floats
  torch::Tensor image;       ///< B×3×H×W, 0 on the background
};

/// Codes of the source, computed once.
struct GuidedSource {
  torch::Tensor sil_code, gar_code;
  RenderCode render_code;
};

/// What the target's pictures show of the source.
struct GuidedPseudo {
  torch::Tensor classes, image, silhouette;  ///< G̃, Ĩ, S̃
  /// What SilNet sees of the source, where it does: labels on the target's body, and B×2 how far clothes stand off it
  /// and where that puts them.
  torch::Tensor contour_classes, extent;
};

struct GuidedResult {
  torch::Tensor silhouette;    ///< B×1×H×W, S^t as the picture is made with
  torch::Tensor classes;       ///< B×1×H×W, 0 throughout without GarNet
  torch::Tensor label_logits;  ///< B×7×H×W, undefined without GarNet
  torch::Tensor image;         ///< B×3×H×W, multiplied by the silhouette
};

struct GuidedModelImpl : torch::nn::Module {
  explicit GuidedModelImpl(const GuidedConfig& config);

  /// Class numbers as the networks see them: B×7 of 0 and 1, or B×1 of greys number/6.
  [[nodiscard]] torch::Tensor LabelMap(const torch::Tensor& classes) const;
  /// The same of labels that come from the source, be it of its own picture or carried to the target's: zero where the
  /// source's labels are left out.
  [[nodiscard]] torch::Tensor SourceLabelMap(const torch::Tensor& classes) const;
  /// What comes from the source's silhouette: itself, S̃, the clothes' extent; zero where that is left out.
  [[nodiscard]] torch::Tensor OfSourceSilhouette(const torch::Tensor& map) const;
  /// Of the source's whole pictures. Parts whose networks are left out are undefined.
  GuidedSource EncodeSource(const GuidedTensors& source);
  /// B×1 logits of S^t; B×7 logits of G^t (`silhouette` undefined: SilNet is left out).
  torch::Tensor Silhouette(const GuidedSource& source, const torch::Tensor& pose, const GuidedPseudo& pseudo,
                           const CodeBox& box);
  torch::Tensor Labels(const GuidedSource& source, const torch::Tensor& pose, const torch::Tensor& silhouette,
                       const torch::Tensor& pseudo_classes, const CodeBox& box);
  /// RenderNet alone. `code`: the source's code, drawn or not; silhouette and classes may be undefined where their
  /// networks are left out. Returns the image and the silhouette it was multiplied by.
  std::pair<torch::Tensor, torch::Tensor> Render(const torch::Tensor& code, const torch::Tensor& pose,
                                                 const torch::Tensor& silhouette, const torch::Tensor& classes,
                                                 const GuidedPseudo& pseudo, const CodeBox& box);
  /// The chain, each network fed by the one before; without gradients.
  GuidedResult forward(const GuidedSource& source, const torch::Tensor& pose, const GuidedPseudo& pseudo,
                       const CodeBox& box);

  GuidedConfig config;
  SilNet sil{nullptr};
  GarNet gar{nullptr};
  RenderNet render{nullptr};
};
TORCH_MODULE(GuidedModel);

/// The discriminator that a run trains against: it sees the true labels beside the picture.
PatchDiscriminator GuidedDiscriminator(const GuidedConfig& config);

// Known colours, carried on over the garment that they belong to. Internal: includes LibTorch.
//
// x_k = PullPush(Ĩ, S̃ [G̃ = k]),   x = x_k where G = k and k is known somewhere in the picture,
// PullPush(Ĩ, S̃) elsewhere
// So a skirt's rim takes its colour from the skirt on the thigh, not from the stocking beside it. Where the pixel
// itself is known under its label the colour is its own.

/// image: B×3×H×W, known: B×1×H×W of zeros and ones (Ĩ, S̃), known_classes and classes: B×1×H×W class numbers (G̃, G;
/// `classes` may be undefined: every pixel then takes what is nearest). Returns B×3×H×W. No gradient.
torch::Tensor CarryColours(const torch::Tensor& image, const torch::Tensor& known, const torch::Tensor& known_classes,
                           const torch::Tensor& classes);

}  // namespace bodyloom
