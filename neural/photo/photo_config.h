// SPDX-License-Identifier: Apache-2.0
/// Configuration of the one-photo renderer (Sarkar et al., ECCV 2020): sizes and the paper's variants.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

/// The paper gives 256² images and textures, 16 features, four levels of the texture network, three levels and six
/// residual blocks of the image network, three scales of discriminators; the widths are this project's choice.
struct PhotoProfile {
  std::string name;
  int image_size = 0;    ///< side S of the windows, pixels
  int texture_size = 0;  ///< side U of the textures, texels
  int features = 0;      ///< channels d of the features in UV
  std::vector<int> feature_widths;
  int render_width = 0, render_blocks = 0;
  int discriminator_width = 0, discriminator_layers = 0, discriminator_scales = 0;
  int perceptual_divisor = 1;  ///< divides the channels of VGG's random-feature substitute
  /// RenderNet's last convolution also sees R, its colours extended outwards and the body's silhouette, and is
  /// initialised to return those colours and that silhouette. Instance norm removes colours from all maps before, and
  /// learning to restore them is too slow on two cores. Not in the paper.
  bool render_passes_input = false;
  /// FeatureNet also sees guessed colours of texels that the photo does not show
  /// (render/texture/complete/partial_texture.h). Not in the paper.
  bool guesses_unseen = false;
  /// Kernel of RenderNet's transposed convolutions: 3 (the paper's) or 4 (without artefacts of period two).
  int render_up_kernel = 3;
};

/// "paper" (the published sizes), "cpu" (256² and 256², trains and runs on two cores), "tiny" (128², for tests and
/// comparisons). Throws std::invalid_argument for other names, listing these.
const PhotoProfile& PhotoProfileNamed(const std::string& name);

/// Variants of the paper's Section 4.4. RenderNet and the losses on its image are the same in all.
enum class PhotoVariant {
  kFull,      ///< features of the completed texture, the first three being its colours
  kNoInt,     ///< "No-Int": as kFull, without the loss on the texture
  kInpaint,   ///< "IP": 3 colours completed by a pretrained, fixed network
  kWarp,      ///< "Warp": RenderNet sees the colours of the incomplete texture in the target's pose
  kWarpCond,  ///< "WarpCond": as kWarp, and the target's surface coordinates and parts
};

/// "full", "no-int", "ip", "warp", "warpcond"; throws std::invalid_argument for other names, listing these.
PhotoVariant PhotoVariantNamed(const std::string& name);
const char* ToText(PhotoVariant variant);

struct PhotoConfig {
  PhotoProfile profile;
  PhotoVariant variant = PhotoVariant::kFull;

  /// True if there is a FeatureNet.
  [[nodiscard]] bool Completes() const { return variant != PhotoVariant::kWarp && variant != PhotoVariant::kWarpCond; }
  /// True if FeatureNet sees guesses.
  [[nodiscard]] bool GuessesUnseen() const { return Completes() && profile.guesses_unseen; }
  /// Output channels of FeatureNet; 0 without it.
  [[nodiscard]] int TextureChannels() const;
  /// Input channels of RenderNet: d, 3, 3 and 6.
  [[nodiscard]] int RenderChannels() const;
  /// Extra input channels of RenderNet's last convolution: three colours extended outwards, R and the body's
  /// silhouette; or none.
  [[nodiscard]] int PassedChannels() const { return profile.render_passes_input ? RenderChannels() + 4 : 0; }
  /// Minimum side of an image for the discriminator.
  [[nodiscard]] int SmallestSide() const;
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// One line that identifies the configuration: everything that the networks' shapes and meaning depend on.
std::string ToText(const PhotoConfig& config);

}  // namespace bodyloom
