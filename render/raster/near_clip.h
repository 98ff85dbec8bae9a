// SPDX-License-Identifier: Apache-2.0
/// Clips faces that reach behind the near plane or far outside the image, so that they can be projected.
#pragma once

#include <Eigen/Core>
#include <array>

#include "geometry/scene/camera.h"

namespace bodyloom {

/// A convex polygon of at most 3 + 5 corners in the camera frame, in the order of the face it was cut from.
struct ClippedPolygon {
  std::array<Eigen::Vector3d, 8> corners;
  int size = 0;
};

/// The part of a triangle (camera frame, metres) with z >= near_m (pinhole only) and |x_px|, |y_px| < guard_px; may be
/// empty. Clipped in space, before any division by depth. The two faces of a shared edge are clipped at the same
/// points. With lens distortion only the near plane clips, because edges are not straight on the screen.
ClippedPolygon ClipTriangle(const std::array<Eigen::Vector3d, 3>& corners, const Camera& camera, double near_m,
                            double guard_px);

}  // namespace bodyloom
