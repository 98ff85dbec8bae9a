// SPDX-License-Identifier: Apache-2.0
/// The three networks of the pose-guided renderer. Internal: includes LibTorch.
///
///   S^t = sigmoid SilNet(P^t | {P^s, S^s, G^s})
///   G^t = softmax GarNet(G̃^t | P^t, S^t, {P^s, S^s, G^s})
///   I^t = S^t · sigmoid RenderNet(Ĩ^t, S̃^t | S^t, G^t, {I^s, S^s, G^s})
/// Source: Yoon et al., "Pose-Guided Human Animation from a Single Image in the Wild", CVPR 2021, Section 3.1. P:
/// colours of body parts (render/texture/complete/body_part_map.h); S: silhouette; G: garment labels; tilde: pseudo
/// inputs, the known part of the target on the bare body.
///
/// SilNet has separate encoders for source and target, GarNet one for both (guided_networks.h). Images of the source
/// fill the whole window; those of the target may be cropped to a box of code cells, to which the source's codes are
/// then cropped too.
#pragma once

#include <torch/torch.h>
#include <cstdint>
#include <vector>

#include "neural/guided/guided_config.h"
#include "neural/guided/guided_networks.h"
#include "neural/networks/patch_discriminator.h"

namespace bodyloom {

/// Inputs of B images; undefined if not known.
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

/// Pseudo inputs of the target's images.
struct GuidedPseudo {
  torch::Tensor classes, image, silhouette;  ///< G̃, Ĩ, S̃
  /// Contour hints of SilNet, if used: labels on the target's body, and B×2 the clothes' offset from it and the
  /// predicted clothed silhouette.
  torch::Tensor contour_classes, clothes_offset;
};

struct GuidedResult {
  torch::Tensor silhouette;    ///< B×1×H×W, S^t that multiplies the image
  torch::Tensor classes;       ///< B×1×H×W, 0 throughout without GarNet
  torch::Tensor label_logits;  ///< B×7×H×W, undefined without GarNet
  torch::Tensor image;         ///< B×3×H×W, multiplied by the silhouette
};

struct GuidedModelImpl : torch::nn::Module {
  explicit GuidedModelImpl(const GuidedConfig& config);

  /// Labels as network input: B×7 one-hot, or B×1 of greys number/6.
  [[nodiscard]] torch::Tensor LabelMap(const torch::Tensor& classes) const;
  /// The same for labels from the source, in its own image or transferred to the target: zero if the source's labels
  /// are left out.
  [[nodiscard]] torch::Tensor SourceLabelMap(const torch::Tensor& classes) const;
  /// A map derived from the source's silhouette (itself, S̃, the clothes' offset), or zero if that is left out.
  [[nodiscard]] torch::Tensor OfSourceSilhouette(const torch::Tensor& map) const;
  /// Encodes the source's whole images. Codes of networks that are left out are undefined.
  GuidedSource EncodeSource(const GuidedTensors& source);
  /// B×1 logits of S^t; B×7 logits of G^t (`silhouette` undefined: SilNet is left out).
  torch::Tensor Silhouette(const GuidedSource& source, const torch::Tensor& pose, const GuidedPseudo& pseudo,
                           const CodeBox& box);
  torch::Tensor Labels(const GuidedSource& source, const torch::Tensor& pose, const torch::Tensor& silhouette,
                       const torch::Tensor& pseudo_classes, const CodeBox& box);
  /// RenderNet alone. `code`: the source's code, sampled or not; silhouette and classes may be undefined if their
  /// networks are left out. Returns the image and the silhouette it was multiplied by.
  std::pair<torch::Tensor, torch::Tensor> Render(const torch::Tensor& code, const torch::Tensor& pose,
                                                 const torch::Tensor& silhouette, const torch::Tensor& classes,
                                                 const GuidedPseudo& pseudo, const CodeBox& box);
  /// The whole chain, each network using the results of those before; without gradients.
  GuidedResult forward(const GuidedSource& source, const torch::Tensor& pose, const GuidedPseudo& pseudo,
                       const CodeBox& box);

  GuidedConfig config;
  SilNet sil{nullptr};
  GarNet gar{nullptr};
  RenderNet render{nullptr};
};
TORCH_MODULE(GuidedModel);

/// The discriminator of the training; its input is the image with the true labels.
PatchDiscriminator GuidedDiscriminator(const GuidedConfig& config);

// Extends known colours over the garment that they belong to.
//
//   x_k = PullPush(Ĩ, S̃ [G̃ = k]),   x = x_k where G = k and k is known somewhere in the image,
//                                     PullPush(Ĩ, S̃) elsewhere
// Thus the rim of a skirt takes its colour from the skirt on the thigh, not from the stocking beside it. Pixels known
// under their label keep their colour.

/// image: B×3×H×W, known: B×1×H×W of zeros and ones (Ĩ, S̃), known_classes and classes: B×1×H×W class numbers (G̃, G;
/// `classes` may be undefined: every pixel then takes the nearest colours). Returns B×3×H×W. No gradient.
torch::Tensor CarryColours(const torch::Tensor& image, const torch::Tensor& known, const torch::Tensor& known_classes,
                           const torch::Tensor& classes);

}  // namespace bodyloom
