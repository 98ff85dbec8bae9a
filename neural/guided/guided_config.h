// SPDX-License-Identifier: Apache-2.0
/// Configuration of the pose-guided renderer (Yoon et al., "Pose-Guided Human Animation from a Single Image in the
/// Wild", CVPR 2021): sizes and ablations.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

/// Completion of texels that no photo shows.
enum class MapCompletion {
  kNone,          ///< they stay empty: the source is only warped (the paper's −A)
  kVirtualViews,  ///< six views of the body, rendered by the networks (complete_maps.h), as in the paper
  kNearest        ///< the nearest seen texels, with sides, and front and back, identified (source_maps.h)
};

/// "none", "virtual views", "nearest texels".
const char* ToText(MapCompletion completion);

/// The paper gives image and texture sizes but neither channels nor levels; these are this project's choice
/// (docs/lab/pose_guided_renderer.md).
struct GuidedProfile {
  std::string name;
  int image_size = 0;               ///< side of the window, pixels
  int texture_size = 0;             ///< side of the coherent maps, texels
  std::vector<int> shape_widths;    ///< channels of the levels of SilNet and GarNet, finest first
  std::vector<int> encoder_widths;  ///< of RenderNet's three encoders; as many levels
  std::vector<int> decoder_widths;  ///< of RenderNet's decoder; as many levels
  int full_width = 0;               ///< of RenderNet's block at full size
  int modulation_width = 0;         ///< maximum hidden channels of a modulation; further limited by the level's width
  int latent = 0;                   ///< channels of the source's code, at the coarsest level
  bool one_hot_labels = false;      ///< labels as seven channels; false: as one grey value, as in the paper
  bool spectral_norm = false;       ///< in RenderNet's decoder
  int discriminator_width = 0;
  int perceptual_divisor = 1;    ///< divides the channels of VGG's random-feature substitute
  int contextual_points = 0;     ///< randomly drawn positions that the contextual loss compares
  bool fill_colours = false;     ///< RenderNet's last convolution sees known colours extended over their garment
  bool start_from_body = false;  ///< SilNet has the bare body as an extra input, and initially returns its silhouette
  bool contour_hints = false;    ///< SilNet also sees the clothes' labels and clothes_offset on the target's body
  bool nearest_texels = false;   ///< the maps are completed by MapCompletion::kNearest, else from virtual views
};

/// "paper" (256², the published resolution), "cpu" (256², trains and runs on two cores), "tiny" (128², for tests).
/// Throws std::invalid_argument for other names, listing these.
const GuidedProfile& GuidedProfileNamed(const std::string& name);

struct GuidedConfig {
  GuidedProfile profile;
  // The paper's ablations (Table 2); all true: S+G+R. Inputs that are left out are zero.
  bool silhouettes = true;  ///< SilNet; without it RenderNet predicts the silhouette itself (or GarNet does)
  bool garments = true;     ///< GarNet
  /// S^s, "from the entire pipeline": also what derives from it in the target, S̃^t and the clothes' offsets.
  bool source_silhouette = true;
  bool source_labels = true;  ///< M^s, called G^s elsewhere in the paper, and G̃^t, which derives from it
  bool latent = true;         ///< z^s
  bool kl = true;             ///< L_KL; without it the code is deterministic, from fully connected layers
  bool pseudo_image = true;   ///< Ĩ^t and S̃^t
  bool uv_appearance = true;  ///< A: the completed maps; without it the source is only warped

  [[nodiscard]] int Levels() const { return static_cast<int>(profile.shape_widths.size()); }
  [[nodiscard]] MapCompletion Completion() const {
    if (!uv_appearance) return MapCompletion::kNone;
    return profile.nearest_texels ? MapCompletion::kNearest : MapCompletion::kVirtualViews;
  }
  /// True if the neighbours of texels are needed.
  [[nodiscard]] bool NeedsNeighbours() const {
    return profile.contour_hints || Completion() == MapCompletion::kNearest;
  }
  /// Sides and crops of the images must be multiples of this.
  [[nodiscard]] int Multiple() const { return 1 << Levels(); }
  /// True if RenderNet sees the pose map, because a network that provides the target's shape is left out.
  [[nodiscard]] bool PoseForRender() const { return !silhouettes || !garments; }
  [[nodiscard]] int LabelChannels() const { return profile.one_hot_labels ? 7 : 1; }
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// The names that LeaveOut takes.
const std::vector<std::string>& GuidedParts();
/// Disables a part: "sil", "gar", "source-silhouette", "source-labels", "latent", "kl", "pseudo-image",
/// "uv-appearance". Throws std::invalid_argument for other names.
void LeaveOut(const std::string& part, GuidedConfig* config);
/// The disabled parts.
std::vector<std::string> LeftOut(const GuidedConfig& config);

/// One line that identifies the configuration: names and values of everything that the networks depend on.
std::string ToText(const GuidedConfig& config);

}  // namespace bodyloom
