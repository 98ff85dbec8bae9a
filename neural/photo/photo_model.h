// SPDX-License-Identifier: Apache-2.0
/// The networks of the one-photo renderer. Internal: includes LibTorch.
///
///   F_s = f(T_s + G_s, M_s)      FeatureNet on the partial texture's colours, guesses at those of the other texels
///                                (render/texture/complete/partial_texture.h; the paper has none) and visibility, in
///                                UV; d channels
///   R   = r(F_s, P_t)            bilinear sampling at the target pose's surface coordinates, 0 off the body
///   c, α = tanh, sigmoid g(R)    RenderNet;  I = α (c + 1)/2. If its last convolution sees R
///                                (PhotoProfile::render_passes_input), it also sees R's colours extended outwards from
///                                the body (neural/networks/uv_sampler.h), as initial colours of clothes beyond it,
///                                and the body's silhouette
/// Source: Sarkar et al., "Neural Re-Rendering of Humans from a Single Image", ECCV 2020, Sections 3.2–3.4. The paper's
/// RenderNet has three outputs on its photographs' plain background; the fourth is this project's
/// (docs/lab/one_photo_renderer.md).
///
/// FeatureNet's last convolution is initialised as N(0, 0.02²) plus an identity that copies the input's colours to the
/// first three features, so that visible texels need not be learned.
///
/// Variants (neural/photo/photo_config.h): without FeatureNet F_s is T_s itself; with kWarpCond R has the target's
/// coordinates and parts (u, v, part/24, 0 off the body) beside it.
#pragma once

#include <torch/torch.h>

#include "neural/base/rendered_person.h"
#include "neural/networks/patch_discriminator.h"
#include "neural/networks/residual_generator.h"
#include "neural/photo/photo_config.h"
#include "neural/photo/photo_tensors.h"

namespace bodyloom {

struct PhotoResult {
  torch::Tensor image;        ///< B×3×h×w in [0, 1], multiplied by alpha
  torch::Tensor alpha_logit;  ///< B×1×h×w
  torch::Tensor alpha;        ///< B×1×h×w
};

struct PhotoModelImpl : torch::nn::Module {
  explicit PhotoModelImpl(const PhotoConfig& config);

  /// Computes F_s. Its first three channels are colours 2c − 1, as in T_s.
  torch::Tensor Complete(const TextureTensors& texture);
  /// Computes R from F_s.
  [[nodiscard]] torch::Tensor Project(const torch::Tensor& features, const PoseTensors& pose) const;
  /// `body`: PoseTensors::body of the same windows.
  PhotoResult Render(const torch::Tensor& projected, const torch::Tensor& body);
  PhotoResult forward(const TextureTensors& texture, const PoseTensors& pose);

  PhotoConfig config;
  FeatureUNet feature_net{nullptr};  ///< empty for kWarp and kWarpCond
  ResidualGenerator render_net{nullptr};
};
TORCH_MODULE(PhotoModel);

/// The discriminators of the training; their input is the image with R.
MultiScaleDiscriminator PhotoDiscriminator(const PhotoConfig& config);

/// Renders one pose from the features of a source.
/// `features`: 1×C×U×U from PhotoModelImpl::Complete. Only the window within `reach` of the body is computed, the rest
/// is background; a negative reach computes the whole frame. A frame without a body gives background. No gradients.
RenderedPerson RenderPhoto(PhotoModel model, const torch::Tensor& features, const PhotoFrame& pose, int reach);

}  // namespace bodyloom
