// SPDX-License-Identifier: Apache-2.0
/// Configuration of the pose-guided renderer (Yoon et al., "Pose-Guided Human Animation from a Single Image in the
/// Wild", CVPR 2021): sizes, and which parts are left out.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

/// What becomes of texels that no photo shows.
enum class MapCompletion {
  kNone,          ///< they stay empty: the source warped as it is (the paper's −A)
  kVirtualViews,  ///< six views of the body, drawn by the networks (complete_maps.h), as in the paper
  kNearest        ///< the nearest texels that a photo shows, both sides, front and back as one (source_maps.h)
};

/// "none", "virtual views", "nearest texels".
const char* ToText(MapCompletion completion);

/// The paper gives image and texture sizes but neither channels nor levels; these are this project's choice
/// (docs/guided_renderer.md).
struct GuidedProfile {
  std::string name;
  int image_size = 0;               ///< side of the window, pixels
  int texture_size = 0;             ///< side of the coherent maps, texels
  std::vector<int> shape_widths;    ///< channels of the levels of SilNet and GarNet, finest first
  std::vector<int> encoder_widths;  ///< of RenderNet's three encoders; as many levels
  std::vector<int> decoder_widths;  ///< of RenderNet's decoder; as many levels
  int full_width = 0;               ///< of RenderNet's block at full size
  int modulation_width = 0;         ///< hidden channels of a modulation at most; a level has no more than its width
  int latent = 0;                   ///< channels of the source's code, at the coarsest level
  bool one_hot_labels = false;      ///< labels as seven channels; false: as one grey, as the paper feeds them
  bool spectral_norm = false;       ///< in RenderNet's decoder
  int discriminator_width = 0;
  int perceptual_divisor = 1;    ///< divides VGG's channels where a random-feature substitute takes its place
  int contextual_points = 0;     ///< positions that the contextual loss compares, drawn at random
  bool fill_colours = false;     ///< RenderNet's last convolution sees known colours carried on over their garment
  bool start_from_body = false;  ///< SilNet sees the bare body as a map of its own, and starts with its silhouette
  bool contour_hints = false;    ///< SilNet sees the clothes' labels and extent on the target's body
  bool nearest_texels = false;   ///< the maps are completed by MapCompletion::kNearest, else over virtual views
};

/// "paper" (256², the published resolution), "cpu" (256², trains and runs on two cores), "tiny" (128², for tests).
/// Throws std::invalid_argument for other names, listing these.
const GuidedProfile& GuidedProfileNamed(const std::string& name);

struct GuidedConfig {
  GuidedProfile profile;
  // The paper's ablations (Table 2); all true: S+G+R. What is left out of the inputs is zero.
  bool silhouettes = true;  ///< SilNet; without it RenderNet predicts the silhouette itself (or GarNet does)
  bool garments = true;     ///< GarNet
  /// S^s, "from the entire pipeline": also what comes of it in the target, S̃^t and how far clothes stand off.
  bool source_silhouette = true;
  bool source_labels = true;  ///< M^s, called G^s elsewhere in the paper, and with it G̃^t, in the same way
  bool latent = true;         ///< z^s
  bool kl = true;             ///< L_KL; without it the code is not drawn, and made by fully connected layers
  bool pseudo_image = true;   ///< Ĩ^t and S̃^t
  bool uv_appearance = true;  ///< A: the maps completed over virtual views; without it the source warped as it is

  [[nodiscard]] int Levels() const { return static_cast<int>(profile.shape_widths.size()); }
  [[nodiscard]] MapCompletion Completion() const {
    if (!uv_appearance) return MapCompletion::kNone;
    return profile.nearest_texels ? MapCompletion::kNearest : MapCompletion::kVirtualViews;
  }
  /// Whether the neighbours of texels are needed.
  [[nodiscard]] bool NeedsNeighbours() const {
    return profile.contour_hints || Completion() == MapCompletion::kNearest;
  }
  /// A side of the images must be a multiple of this; pictures are cropped at multiples of it.
  [[nodiscard]] int Multiple() const { return 1 << Levels(); }
  /// RenderNet sees the pose map where a network that would give it the target's shape is left out.
  [[nodiscard]] bool PoseForRender() const { return !silhouettes || !garments; }
  [[nodiscard]] int LabelChannels() const { return profile.one_hot_labels ? 7 : 1; }
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// The names that LeaveOut takes.
const std::vector<std::string>& GuidedParts();
/// Switches a part off: "sil", "gar", "source-silhouette", "source-labels", "latent", "kl", "pseudo-image",
/// "uv-appearance". Throws std::invalid_argument for other names.
void LeaveOut(const std::string& part, GuidedConfig* config);
/// The parts that are switched off.
std::vector<std::string> LeftOut(const GuidedConfig& config);

/// One line that tells two configurations apart: names and values of everything that the networks depend on.
std::string ToText(const GuidedConfig& config);

}  // namespace bodyloom
