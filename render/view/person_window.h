// SPDX-License-Identifier: Apache-2.0
/// A window of one size and scale that follows a person through a clip: what the renderers look at instead of the whole
/// picture.
///
/// All frames are shrunk by the same factor, so that the person's size stays what it is; the window then moves by whole
/// pixels of the shrunk picture, and only when the person would leave it, so that what a network predicted for the
/// frame before can be laid over this one exactly.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "geometry/scene/camera.h"
#include "render/image/image.h"

namespace bodyloom {

/// Extent of the person in a frame, pixels of the original picture; empty (max < min): not in this frame.
struct PersonExtent {
  Eigen::Vector2d min{0, 0}, max{-1, -1};
  [[nodiscard]] bool empty() const { return !(max.x() >= min.x() && max.y() >= min.y()); }
};

struct PersonWindow {
  int width = 0, height = 0;                  ///< of the window
  int picture_width = 0, picture_height = 0;  ///< of the shrunk picture
  double scale_x = 1, scale_y = 1;            ///< shrunk over original size; they differ by what rounding the size took
  std::vector<Eigen::Vector2i> corner;        ///< top-left pixel in the shrunk picture, by frame; may lie outside
};

struct PersonWindowOptions {
  int max_side = 256;    ///< of the window; the person is never enlarged to fill it
  double scale = 0;      ///< shrunk (or enlarged) by this much, however large the window gets; 0: to fit max_side
  int multiple = 16;     ///< the window's sides are multiples of this
  double margin = 0.15;  ///< of the extent's longer side, on every side: clothes and hair reach beyond the body
};

/// `extents` has an entry a frame. Frames without a person keep the window of the frame before. Throws
/// std::invalid_argument when no frame has a person, or sizes or options make no sense.
PersonWindow PlanPersonWindow(const std::vector<PersonExtent>& extents, int image_width, int image_height,
                              const PersonWindowOptions& options = {});

/// The camera whose image is the window of frame t. Weak perspective has one scale: the mean of both, off by what
/// rounding the picture's size took (below 0.05 % for pictures of 1000 pixels).
Camera CameraInWindow(const Camera& camera, const PersonWindow& window, int t);

/// The window's part of a frame's picture (area means; black outside). Throws std::invalid_argument when the picture is
/// not of the size that the window was planned for.
Image CutWindow(const Image& picture, const PersonWindow& window, int t);

/// The same for pictures whose values must not be mixed: the first channel of the nearest pixel, 0 outside.
std::vector<uint8_t> CutLabels(const Image& labels, const PersonWindow& window, int t);

}  // namespace bodyloom
