// SPDX-License-Identifier: Apache-2.0
/// The texture of a tracked person from the frames of the video, by gathering: texel → point of the tracked surface →
/// pixel, where the visibility buffer says that the camera sees it (render/texture/texel_sight.h). No texel is left out
/// because no pixel happened to fall on it, as happens when pixels are scattered into the map.
///
/// A sample weighs cosine² · min(1, texels of a pixel)⁻¹: views from the front and from near count more. A texel keeps
/// its `keep` best samples of all frames; its colour is their weighted median channel by channel (or mean), so that a
/// frame in which an arm was misplaced does not stain it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/uv_maps/uv_texels.h"
#include "render/image/image.h"
#include "render/texture/texel_sight.h"

namespace bodyloom {

struct TextureExtractOptions {
  UvTexelOptions texels{.width = 512, .height = 512, .gutter = 1};
  TexelSightOptions sight{.min_cosine = 0.2, .bias_m = 0.003, .slope = 1.5, .whole_footprint = true};
  /// Pixels this near to the body's contour, or to where a limb hides another (a step of edge_step_m in depth), are not
  /// used: there the picture is blurred and the track a little off. 0 to 64.
  int edge_margin_px = 2;
  /// The same for steps alone, which move with the error of a limb's pose; −1: edge_margin_px. −1 to 64.
  int step_margin_px = -1;
  double edge_step_m = 0.05;
  enum class Merge { kMedian, kMean } merge = Merge::kMedian;
  int keep = 9;  ///< samples a texel, 1 to 64
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Planes of H·W; texels without a sample are 0 with confidence 0.
struct Texture {
  int width = 0, height = 0;
  std::vector<float> bgr;         ///< three planes, 0 to 1
  std::vector<float> confidence;  ///< weight of the best sample, 0 (never seen) to 1 (seen frontally, a pixel a texel)
  std::vector<int> source_frame;  ///< of the best sample; −1
  std::vector<float> source_x_px, source_y_px;
  int num_seen = 0;  ///< texels with a sample
};

class TextureExtractor {
 public:
  /// Borrows the body. Throws std::invalid_argument when options are not valid or the body has no UV.
  explicit TextureExtractor(const BodyModel& body, const TextureExtractOptions& options = {});

  [[nodiscard]] const UvTexelTable& table() const { return table_; }

  /// Adds what `image` shows. `frame` names the image in Texture::source_frame. `person`: one a pixel of the image, 0
  /// where it shows something else, of which edge_margin_px (at least 1) keeps away as from a contour; empty: not
  /// known. Returns the number of texels seen. Throws std::invalid_argument when image, `person` and camera differ in
  /// size.
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
  std::vector<Sample> samples_;     ///< keep a texel of the table
  std::vector<uint8_t> near_edge_;  ///< of the buffer's box, contours and steps in depth
};

/// Colour of the image at a place between pixels, bilinear, 0 to 1; the border's colour outside.
void SampleImage(const Image& image, double x_px, double y_px, float bgr[3]);

}  // namespace bodyloom
