// SPDX-License-Identifier: Apache-2.0
/// Removes the distortion of a lens from images.
#pragma once

#include <optional>
#include <vector>

#include "geometry/scene/camera.h"
#include "render/image/image.h"

namespace bodyloom {

struct ImagePixel {
  int x = 0, y = 0;
};

/// Images of a pinhole camera as the same camera would see them without distortion: same size, focal lengths and
/// principal point. Parts that the lens did not see are black.
class LensCorrection {
 public:
  /// Projects the ray of every pixel (Camera::Project). Throws std::invalid_argument for a camera that is not a pinhole
  /// or has no image size.
  explicit LensCorrection(const Camera& camera);

  /// The camera of the corrected images.
  [[nodiscard]] const Camera& ideal() const { return ideal_; }
  /// Interpolated bilinearly. Throws std::invalid_argument for another image size than the camera's.
  [[nodiscard]] Image Corrected(const Image& image) const;
  /// The pixel of the lens' image that is nearest to pixel (x, y) of the corrected one; none outside its image.
  [[nodiscard]] std::optional<ImagePixel> SourceOf(int x, int y) const;

 private:
  Camera ideal_;
  std::vector<float> xs_, ys_;  ///< place of each pixel in the lens' image, row-major; −10 where there is none
};

}  // namespace bodyloom
