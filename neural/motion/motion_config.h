// SPDX-License-Identifier: Apache-2.0
/// Configuration of the motion-dependent renderer (Yoon et al., CVPR 2022): sizes and ablations.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

/// The paper gives blocks and resolutions but no channels or levels; these are this project's choice
/// (docs/lab/motion_renderer.md).
struct MotionProfile {
  std::string name;
  int image_size = 0;                          ///< longer side of the rendered window, pixels
  int uv_size = 0;                             ///< side of the UV maps, texels
  int features = 0;                            ///< channels d of the motion descriptor f_3D
  int texture_size = 0, texture_features = 0;  ///< side, texels, and channels of the learned texture
  std::vector<int> encoder_widths, decoder_widths;
  int discriminator_width = 0;
  int perceptual_divisor = 1;  ///< divides the channels of VGG's random-feature substitute
};

/// "paper" (512², the published resolutions), "cpu" (256², trains and runs on two cores), "tiny" (128², for tests).
/// Throws std::invalid_argument for other names, listing these.
const MotionProfile& MotionProfileNamed(const std::string& name);

/// Representation of motion as the networks' input.
enum class MotionDescriptor {
  kSurface,  ///< normals and velocities of the body's surface, in UV: the paper's
  /// Dense UV coordinates and keypoints of ten frames, in the image's plane, as Wang et al., "Dance In the Wild", 2021,
  /// describe motion: the paper's baseline for its own descriptor (data_tools/descriptors/dense_history.h). The encoder
  /// works on images and its features go straight to the decoders.
  kDense2d
};
/// "surface", "dense2d".
const char* ToText(MotionDescriptor descriptor);
/// Throws std::invalid_argument for other names, listing these.
MotionDescriptor MotionDescriptorNamed(const std::string& name);
const std::vector<std::string>& MotionDescriptorNames();

struct MotionConfig {
  MotionProfile profile;
  MotionDescriptor descriptor = MotionDescriptor::kSurface;
  int motion_channels = 33;  ///< of the descriptor: N_t and the velocities of ten frames
  int num_labels = 7;        ///< classes of the shape decoder; label 0 is the background
  // The paper's ablations (Table 3): without the shape decoder; without predicted surface normals; with rendered UV
  // coordinates in place of the projected motion descriptor.
  bool shape = true, normals = true, motion = true;
  /// The decoders also see the rendered UV coordinates, beside the projected descriptor. The paper's do not: they must
  /// infer the visible part of the body from normals and velocities alone, which is learned slowly
  /// (docs/lab/motion_renderer.md).
  bool surface = true;
  /// The decoders also see a learned texture: motion-independent values per texel, trained with the networks. Not in
  /// the paper, whose networks must store patterns of clothes in their weights; source: Thies, Zollhöfer, Nießner,
  /// "Deferred Neural Rendering", SIGGRAPH 2019.
  bool texture = true;
  /// The networks see only the box of the body grown by the reach of clothes (neural/motion/person_box.h) instead of
  /// the whole window. Their instance norms depend on this, so it must not change within a run.
  bool around_body = false;

  /// Sides of the images must be multiples of this.
  [[nodiscard]] int Multiple() const { return 1 << profile.decoder_widths.size(); }
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// One line that identifies the configuration: names and values of everything that the networks' shapes depend on.
std::string ToText(const MotionConfig& config);

}  // namespace bodyloom
