// SPDX-License-Identifier: Apache-2.0
/// RenderNet: the person's picture in another pose. Internal: includes LibTorch.
///
///   z ~ N(μ, σ²),  μ, log σ² = Conv3(enc_z(I^s, S^s, G^s))           (at the deepest level)
///   f = enc_G(G^t, S^t),  g = enc_I(Ĩ^t, S̃^t)                        (features of every level)
///   x = Conv3(z);  for each level, coarsest first: x = up2(ModulatedBlock(x | f_l, g_l));
///   x = ModulatedBlock(x | (G^t, S^t), (Ĩ^t, S̃^t)),  result Conv3(LReLU(x), X^t, S̃^t)   (at full size)
/// So both of the target's encoders condition every level, and the maps themselves the last one; the last convolution
/// sees the known colours X^t themselves (Ĩ^t, or Ĩ^t carried on), so that what is known need not be painted again.
/// Without the latent code z = 0. Without L_KL the code is not drawn: z comes out of fully connected layers on the mean
/// over enc_z's deepest features, the same at every place. Without SilNet and GarNet together a fourth channel predicts
/// the silhouette. Source: Yoon et al., CVPR 2021, Fig. 6, which gives neither channels nor levels.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "bodyloom/neural/guided/coder.h"
#include "bodyloom/neural/guided/guided_config.h"
#include "bodyloom/neural/networks/spatial_modulation.h"

namespace bodyloom {

/// log_variance is undefined where the code is not drawn; mean is undefined without a code.
struct RenderCode {
  torch::Tensor mean, log_variance;
};

/// μ + σ ε; with undefined ε, or where nothing is drawn, μ.
torch::Tensor Draw(const RenderCode& code, const torch::Tensor& noise);

struct RenderNetImpl : torch::nn::Module {
  explicit RenderNetImpl(const GuidedConfig& config);
  /// B×(4 + label channels)×H×W: image, silhouette, labels.
  RenderCode EncodeSource(const torch::Tensor& triplet);
  /// code: B×latent at the deepest level (undefined: zero); guide: labels, silhouette and, where a network is left out,
  /// the pose map; pseudo: B×4, Ĩ and S̃; shown: B×3, the colours that the last convolution sees, Ĩ or Ĩ carried on
  /// beyond what is known of it (carry_colours.h). Returns B×3 (4 where RenderNet predicts the silhouette itself)
  /// linear.
  torch::Tensor forward(const torch::Tensor& code, const torch::Tensor& guide, const torch::Tensor& pseudo,
                        const torch::Tensor& shown);

  GuidedConfig config;
  Encoder source_encoder{nullptr}, guide_encoder{nullptr}, pseudo_encoder{nullptr};
  torch::nn::Conv2d code_head{nullptr}, first{nullptr}, last{nullptr};
  torch::nn::Linear flat1{nullptr}, flat2{nullptr};
  std::vector<ModulatedBlock> blocks;  ///< finest first
  ModulatedBlock full{nullptr};
};
TORCH_MODULE(RenderNet);

}  // namespace bodyloom
