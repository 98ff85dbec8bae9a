// SPDX-License-Identifier: Apache-2.0
/// Configuration of the one-photo renderer (Sarkar et al., ECCV 2020): sizes, and which of the paper's variants it is.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

/// The paper gives 256² pictures and textures, 16 features, four levels down and up in the texture, three levels and
/// six residual blocks in the picture, three scales of discriminators; the widths are this project's choice.
struct PhotoProfile {
  std::string name;
  int image_size = 0;    ///< side S of the windows, pixels
  int texture_size = 0;  ///< side U of the textures, texels
  int features = 0;      ///< channels d of the features in UV
  std::vector<int> feature_widths;
  int render_width = 0, render_blocks = 0;
  int discriminator_width = 0, discriminator_layers = 0, discriminator_scales = 0;
  int perceptual_divisor = 1;  ///< divides VGG's channels where a random-feature substitute takes its place
  /// RenderNet's last convolution sees R, its colours filled outwards and the body's silhouette too, and begins with
  /// those colours and that silhouette.
  /// Instance norm takes colours out of every map before; how they come back is learned, which takes longer than two
  /// cores can wait. Not in the paper.
  bool render_passes_input = false;
  /// FeatureNet sees guesses at the colours of texels that the photo does not show
  /// (render/texture/complete/partial_texture.h). Not in the paper.
  bool guesses_unseen = false;
  /// Of RenderNet's transposed convolutions: 3 (the paper's) or 4 (no grain of every other pixel).
  int render_up_kernel = 3;
};

/// "paper" (the published sizes), "cpu" (256² and 256², trains and runs on two cores), "tiny" (128², for tests and
/// comparisons). Throws std::invalid_argument for other names, listing these.
const PhotoProfile& PhotoProfileNamed(const std::string& name);

/// The paper's Section 4.4. RenderNet and the losses on its picture are the same in all.
enum class PhotoVariant {
  kFull,      ///< features of the completed texture, the first three tied to its colours
  kNoInt,     ///< "No-Int": as kFull, without the loss on the texture
  kInpaint,   ///< "IP": colours completed by a network trained before and then fixed; RenderNet sees its 3 colours
  kWarp,      ///< "Warp": RenderNet sees the colours of the incomplete texture in the target's pose
  kWarpCond,  ///< "WarpCond": as kWarp, and the target's surface coordinates and parts
};

/// "full", "no-int", "ip", "warp", "warpcond"; throws std::invalid_argument for other names, listing these.
PhotoVariant PhotoVariantNamed(const std::string& name);
const char* ToText(PhotoVariant variant);

struct PhotoConfig {
  PhotoProfile profile;
  PhotoVariant variant = PhotoVariant::kFull;

  /// Whether there is a FeatureNet.
  [[nodiscard]] bool Completes() const { return variant != PhotoVariant::kWarp && variant != PhotoVariant::kWarpCond; }
  /// Whether FeatureNet sees guesses.
  [[nodiscard]] bool GuessesUnseen() const { return Completes() && profile.guesses_unseen; }
  /// Channels that FeatureNet makes; 0 without it.
  [[nodiscard]] int TextureChannels() const;
  /// Channels of what RenderNet sees: d, 3, 3 and 6.
  [[nodiscard]] int RenderChannels() const;
  /// Channels that RenderNet's last convolution sees beside its own: three colours filled outwards, R and the body's
  /// silhouette; or none.
  [[nodiscard]] int PassedChannels() const { return profile.render_passes_input ? RenderChannels() + 4 : 0; }
  /// The smallest side of a picture that the discriminator takes.
  [[nodiscard]] int SmallestSide() const;
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// One line that tells two configurations apart: everything that the networks' shapes and meaning depend on.
std::string ToText(const PhotoConfig& config);

}  // namespace bodyloom
