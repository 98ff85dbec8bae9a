// SPDX-License-Identifier: Apache-2.0
/// Plans a window of constant size and scale that follows a person through a clip, used by the renderers instead of the
/// whole image.
///
/// All frames are scaled by the same factor, which preserves changes of the person's size; the window moves by whole
/// pixels of the scaled image, and only when the person would leave it, so that predictions for the previous frame can
/// be aligned with the current one exactly.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "geometry/scene/camera.h"
#include "render/image/image.h"

namespace bodyloom {

/// Extent of the person in a frame, pixels of the original image; empty (max < min): not in this frame.
struct PersonExtent {
  Eigen::Vector2d min{0, 0}, max{-1, -1};
  [[nodiscard]] bool empty() const { return !(max.x() >= min.x() && max.y() >= min.y()); }
};

struct PersonWindow {
  int width = 0, height = 0;              ///< of the window
  int image_width = 0, image_height = 0;  ///< of the scaled image
  double scale_x = 1, scale_y = 1;        ///< scaled over original size; they differ by rounding of the size
  std::vector<Eigen::Vector2i> corner;    ///< top-left pixel in the scaled image, by frame; may lie outside
};

struct PersonWindowOptions {
  int max_side = 256;    ///< of the window; the person is never enlarged to fill it
  double scale = 0;      ///< scale factor for any window size; 0: chosen to fit max_side
  int multiple = 16;     ///< the window's sides are multiples of this
  double margin = 0.15;  ///< share of the extent's longer side, on every side, for clothes and hair
};

/// `extents` has an entry per frame. Frames without a person keep the previous window. Throws std::invalid_argument
/// when no frame has a person, or for invalid sizes or options.
PersonWindow PlanPersonWindow(const std::vector<PersonExtent>& extents, int image_width, int image_height,
                              const PersonWindowOptions& options = {});

/// The camera whose image is the window of frame t. Weak perspective has one scale: the mean of both, with an error due
/// to rounding of the image size (below 0.05 % for images of 1000 pixels).
Camera CameraInWindow(const Camera& camera, const PersonWindow& window, int t);

/// Cuts the window from a frame's image (area means; black outside). Throws std::invalid_argument when the image is not
/// of the size that the window was planned for.
Image CutWindow(const Image& image, const PersonWindow& window, int t);

/// The same for label images: the first channel of the nearest pixel, 0 outside.
std::vector<uint8_t> CutLabels(const Image& labels, const PersonWindow& window, int t);

}  // namespace bodyloom
