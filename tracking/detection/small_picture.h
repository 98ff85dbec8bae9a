// SPDX-License-Identifier: Apache-2.0
/// Frames of a clip shrunk to a smaller grey picture, and the pixels of that picture that people cover.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "geometry/scene/label_image.h"
#include "render/image/image.h"

namespace bodyloom {

/// Size of a shrunk picture. Its pixel (x, y) is centred at scale · (x + ½) − ½ of the frame.
struct SmallPicture {
  int width = 0, height = 0;  ///< of the shrunk picture
  double scale = 1;           ///< pixels of a frame a pixel of the picture, 1 or more

  /// For frames of this size, at most `longer_side` pixels long and wide; smaller frames stay as they are.
  static SmallPicture Of(int frame_width, int frame_height, int longer_side);
  /// The same with the least whole number as scale, which is several times faster to make; up to scale − 1 rows and
  /// columns at the end are left out.
  static SmallPicture ByWholeScale(int frame_width, int frame_height, int longer_side);

  [[nodiscard]] size_t num_pixels() const { return size_t(width) * size_t(height); }
  [[nodiscard]] Eigen::Vector2d ToFrame(const Eigen::Vector2d& pixel) const {
    return (scale * (pixel.array() + 0.5) - 0.5).matrix();
  }
};

/// The frame in grey, by area means: rows from top to bottom. The frame has the size that `size` was made for.
std::vector<uint8_t> ShrunkGrey(const Image& frame, const SmallPicture& size);

/// People in a picture: width·height, not 0 where somebody may be.
using CoveredPixels = std::vector<uint8_t>;

/// Adds a person's mask, in pixels of the frames, with 4 % of its longer side around it.
void CoverMask(const LabelImage& mask, const SmallPicture& size, CoveredPixels* covered);
/// Adds a rectangle between two corners, in pixels of the frames; parts outside the picture are left out.
void CoverBox(double x0, double y0, double x1, double y1, const SmallPicture& size, CoveredPixels* covered);

}  // namespace bodyloom
