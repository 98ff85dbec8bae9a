// SPDX-License-Identifier: Apache-2.0
/// Silhouette of a person, downscaled for comparison with many renderings.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/cloth/loose_garment.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/observations.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

class PersonSilhouette {
 public:
  /// `mask`: of the camera's image, 0 off the person. The image is scaled down until the person's pixels span at most
  /// height_px rows.
  PersonSilhouette(const Camera& camera, const LabelImage& mask, int height_px);

  [[nodiscard]] const Camera& camera() const { return camera_; }  ///< of the small image
  /// x and y must lie in the small image.
  [[nodiscard]] bool IsPerson(int x, int y) const { return person_[size_t(y) * camera_.width + x] != 0; }
  [[nodiscard]] int area() const { return area_; }  ///< pixels of the person

 private:
  Camera camera_;
  std::vector<uint8_t> person_;
  int area_ = 0;
};

/// Renders both sides of cloth; `cloth`: positions of its vertices, camera frame. Faces are those of
/// LooseGarment::cloth: row by row from the pinned ring down, two per column.
VisibilityBuffer SeeGarment(const LooseGarment& garment, std::span<const Eigen::Vector3d> cloth, const Camera& camera);

/// Number of pixels in the symmetric difference of the person and of body and cloth together.
int UnlikePixels(const PersonSilhouette& silhouette, const VisibilityBuffer& body, const VisibilityBuffer& cloth);

/// Per row of faces: pixels beside the bare body that show cloth on the person minus those on the background.
std::vector<int> CoveredBeside(const PersonSilhouette& silhouette, const VisibilityBuffer& bare,
                               const VisibilityBuffer& garment_seen, const LooseGarment& garment);

}  // namespace bodyloom
