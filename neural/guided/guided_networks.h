// SPDX-License-Identifier: Apache-2.0
/// Networks of the pose-guided renderer and their encoder and decoder. Internal: includes LibTorch.
///
/// Encoder: C-BLK(in, w_0), C-BLK(w_0, w_1), …; returns features of all levels, level l with w_l channels at 1/2^(l+1)
/// of the sides. SkipDecoder: D-BLK from the code at the deepest level upwards, concatenated at each level above with
/// the encoder's features of that size, then a 3×3 convolution that also sees the encoder's input; linear output.
/// Blocks: neural/networks/blocks.h.
#pragma once

#include <torch/torch.h>
#include <vector>

#include "neural/guided/guided_config.h"
#include "neural/networks/blocks.h"
#include "neural/networks/spatial_modulation.h"

namespace bodyloom {

struct EncoderImpl : torch::nn::Module {
  EncoderImpl(int in, const std::vector<int>& widths);
  /// B×in×H×W, sides multiples of 2^levels and H·W / 4^levels at least 2 → features, finest first.
  std::vector<torch::Tensor> forward(torch::Tensor x);

  std::vector<ConvBlock> blocks;
};
TORCH_MODULE(Encoder);

struct SkipDecoderImpl : torch::nn::Module {
  /// `code`: channels of the code at the deepest level; `input`: channels of the encoder's input.
  SkipDecoderImpl(int code, const std::vector<int>& widths, int input, int out);
  /// `input` and `features`: of the encoder for the skip connections; its deepest features are not used (they are in
  /// the code).
  torch::Tensor forward(torch::Tensor code, const torch::Tensor& input, const std::vector<torch::Tensor>& features);

  std::vector<DeconvBlock> blocks;  ///< finest first
  torch::nn::Conv2d head{nullptr};
};
TORCH_MODULE(SkipDecoder);

/// Cells of the deepest level covered by a cropped image, within those of the whole window.
struct CodeBox {
  int64_t x = 0, y = 0, width = 0, height = 0;
};

/// Crops B×C×h×w to the box.
torch::Tensor Cropped(const torch::Tensor& map, const CodeBox& box);

// GarNet completes the garment labels in another pose.
//
// One encoder is applied to the triplets {P, S, G} of the source and {P^t, S^t, G̃^t} of the target; their concatenated
// deepest features are decoded, with skip connections from the target's features at every level. Yoon et al., CVPR
// 2021, Fig. 5.

struct GarNetImpl : torch::nn::Module {
  explicit GarNetImpl(const GuidedConfig& config);
  /// B×(4 + label channels)×H×W → the source's code, at the deepest level.
  torch::Tensor EncodeSource(const torch::Tensor& triplet);
  /// Code (of the same size as the target's deepest features) and the target's triplet → B×7 logits.
  torch::Tensor forward(const torch::Tensor& source_code, const torch::Tensor& triplet);

  Encoder encoder{nullptr};
  SkipDecoder decoder{nullptr};
};
TORCH_MODULE(GarNet);

// SilNet predicts the person's silhouette in another pose.
//
// Two encoders, of the source triplet {P, S, G} and of the target's pose map; their concatenated deepest features are
// decoded, with skip connections from the target's features at every level. Yoon et al., CVPR 2021, Fig. 4.

struct SilNetImpl : torch::nn::Module {
  explicit SilNetImpl(const GuidedConfig& config);
  /// B×(4 + label channels)×H×W → the source's code, at the deepest level.
  torch::Tensor EncodeSource(const torch::Tensor& triplet);
  /// Code (of the same size as the target's deepest features), B×3 pose map and, with `contour_hints`, the hints on the
  /// target's body, B×(label channels + 2) (else undefined) → B×1 logits.
  torch::Tensor forward(const torch::Tensor& source_code, const torch::Tensor& pose, const torch::Tensor& seen);

  bool from_body = false;  ///< the target's input ends with the bare body, 0 or 1
  Encoder source_encoder{nullptr}, target_encoder{nullptr};
  SkipDecoder decoder{nullptr};
};
TORCH_MODULE(SilNet);

// RenderNet renders the person in another pose.
//
//   z ~ N(μ, σ²),  μ, log σ² = Conv3(enc_z(I^s, S^s, G^s))           (at the deepest level)
//   f = enc_G(G^t, S^t),  g = enc_I(Ĩ^t, S̃^t)                        (features of every level)
//   x = Conv3(z);  for each level, coarsest first: x = up2(ModulatedBlock(x | f_l, g_l));
//   x = ModulatedBlock(x | (G^t, S^t), (Ĩ^t, S̃^t)),  result Conv3(LReLU(x), X^t, S̃^t)   (at full size)
// Both of the target's encoders condition every level, and the maps themselves the last one; the last convolution also
// sees the known colours X^t (Ĩ^t, or Ĩ^t extended), so that these need not be generated. Without the latent code z is
// 0. Without L_KL the code is deterministic: z is computed by fully connected layers from the mean of enc_z's deepest
// features, constant over positions. Without both SilNet and GarNet a fourth channel predicts the silhouette.
// Source: Yoon et al., CVPR 2021, Fig. 6, which gives neither channels nor levels.

/// log_variance is undefined for a deterministic code; mean is undefined without a code.
struct RenderCode {
  torch::Tensor mean, log_variance;
};

/// Samples μ + σ ε; returns μ for undefined ε or a deterministic code.
torch::Tensor Draw(const RenderCode& code, const torch::Tensor& noise);

struct RenderNetImpl : torch::nn::Module {
  explicit RenderNetImpl(const GuidedConfig& config);
  /// B×(4 + label channels)×H×W: image, silhouette, labels.
  RenderCode EncodeSource(const torch::Tensor& triplet);
  /// code: B×latent at the deepest level (undefined: zero); guide: labels, silhouette and, if a network is left out,
  /// the pose map; pseudo: B×4, Ĩ and S̃; shown: B×3, the colours that the last convolution sees, Ĩ or Ĩ extended
  /// (guided_model.h). Returns B×3 (4 if RenderNet predicts the silhouette itself), linear.
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
