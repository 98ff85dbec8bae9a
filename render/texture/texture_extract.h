// SPDX-License-Identifier: Apache-2.0
/// Extracts the texture of a tracked person from the frames of a video by gathering: texel → point of the tracked
/// surface → pixel, if visible according to the visibility buffer (render/texture/texel_visibility.h). Unlike
/// scattering of pixels into the map, gathering leaves no holes between samples.
///
/// The weight of a sample is cosine² · min(1, texels of a pixel)⁻¹, which favours frontal and near views. A texel keeps
/// its `keep` best samples of all frames; its colour is their weighted median per channel (or mean), which is robust to
/// frames in which an arm was misplaced.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/uv_maps/uv_texels.h"
#include "render/image/image.h"
#include "render/texture/texel_visibility.h"

namespace bodyloom {

struct TextureExtractOptions {
  UvTexelOptions texels{.width = 512, .height = 512, .gutter = 1};
  TexelVisibilityOptions sight{.min_cosine = 0.2, .bias_m = 0.003, .slope = 1.5, .whole_footprint = true};
  /// Pixels within this distance of the body's contour, or of a step of edge_step_m in depth (an occluding limb), are
  /// not used, because of blur and errors of the track. 0 to 64.
  int edge_margin_px = 2;
  /// The same for depth steps alone, whose error is that of a limb's pose; −1: edge_margin_px. −1 to 64.
  int step_margin_px = -1;
  double edge_step_m = 0.05;
  enum class Merge { kMedian, kMean } merge = Merge::kMedian;
  int keep = 9;  ///< samples per texel, 1 to 64
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Planes of H·W; texels without a sample are 0 with confidence 0.
struct Texture {
  int width = 0, height = 0;
  std::vector<float> bgr;         ///< three planes, 0 to 1
  std::vector<float> confidence;  ///< weight of the best sample, 0 (never seen) to 1 (frontal, one pixel per texel)
  std::vector<int> source_frame;  ///< of the best sample; −1
  std::vector<float> source_x_px, source_y_px;
  int num_seen = 0;  ///< texels with a sample
};

class TextureExtractor {
 public:
  /// Borrows the body. Throws std::invalid_argument when options are not valid or the body has no UV.
  explicit TextureExtractor(const BodyModel& body, const TextureExtractOptions& options = {});

  [[nodiscard]] const UvTexelTable& table() const { return table_; }

  /// Adds the samples of `image`. `frame` identifies it in Texture::source_frame. `person`: mask, one per pixel of the
  /// image, 0 off the person, whose boundary counts as a contour (edge_margin_px, at least 1); empty: not known.
  /// Returns the number of texels seen. Throws std::invalid_argument when image, `person` and camera differ in size.
  int Add(const Image& image, const MatrixX3d& vertices_in_camera, const Camera& camera, int frame,
          std::span<const uint8_t> person = {});

  [[nodiscard]] Texture Merge() const;

 private:
  struct Sample {
    float weight = 0;
    float bgr[3] = {};
    int frame = -1;
    float x_px = 0, y_px = 0;
  };
  void FindEdges(std::span<const uint8_t> person, int image_width);
  [[nodiscard]] bool IsNearEdge(float x_px, float y_px) const;

  const BodyModel& body_;
  TextureExtractOptions options_;
  UvTexelTable table_;
  VisibilityBuffer buffer_;
  std::vector<Sample> samples_;     ///< `keep` per texel of the table
  std::vector<uint8_t> near_edge_;  ///< of the buffer's box, contours and steps in depth
};

/// Samples the image bilinearly at a point, 0 to 1; the border's colour outside.
void SampleImage(const Image& image, double x_px, double y_px, float bgr[3]);

}  // namespace bodyloom
