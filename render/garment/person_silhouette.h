// SPDX-License-Identifier: Apache-2.0
/// The pixels of a person in a picture that is small enough to compare many drawings with.
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
  /// `mask`: of the camera's picture, 0 where the person is not. The picture is scaled down until the person's pixels
  /// span at most height_px rows.
  PersonSilhouette(const Camera& camera, const LabelImage& mask, int height_px);

  [[nodiscard]] const Camera& camera() const { return camera_; }  ///< of the small picture
  /// x and y inside of it.
  [[nodiscard]] bool IsPerson(int x, int y) const { return person_[size_t(y) * camera_.width + x] != 0; }
  [[nodiscard]] int area() const { return area_; }  ///< pixels of the person

 private:
  Camera camera_;
  std::vector<uint8_t> person_;
  int area_ = 0;
};

/// Cloth as a camera sees it, from both sides; `cloth`: places of its vertices, camera frame. Faces are those of
/// LooseGarment::cloth: row by row from the pinned ring down, two a column.
VisibilityBuffer SeeGarment(const LooseGarment& garment, std::span<const Eigen::Vector3d> cloth, const Camera& camera);

/// Pixels that show the person or else a body or cloth, but not both.
int UnlikePixels(const PersonSilhouette& silhouette, const VisibilityBuffer& body, const VisibilityBuffer& cloth);

/// By row of faces: how many pixels beside the bare body show cloth where the person is, less those where nobody is.
std::vector<int> CoveredBeside(const PersonSilhouette& silhouette, const VisibilityBuffer& bare,
                               const VisibilityBuffer& garment_seen, const LooseGarment& garment);

}  // namespace bodyloom
