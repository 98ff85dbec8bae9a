// SPDX-License-Identifier: Apache-2.0
/// Virtual cameras: a scaled copy of a camera, and a second camera that sees the same people from the side.
#pragma once

#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"

namespace bodyloom {

/// The camera whose images are `factor` times as large: pixel' = factor · (pixel + ½) − ½, image size rounded.
Camera ScaledCamera(const Camera& camera, double factor);

/// Image pixels per metre at a depth: fy / depth for a pinhole camera (0 up to Camera::kMinDepth), the scale for a
/// weak-perspective one.
double PixelsPerMetre(const Camera& camera, double depth_m);

/// A virtual camera and its pose relative to the video camera.
struct View {
  Camera camera;
  CameraPose from_camera;  ///< point_in_view = rotation · point_in_camera + translation
  /// Transforms points from the video camera's frame to the view's frame (n×3).
  [[nodiscard]] MatrixX3d Apply(const MatrixX3d& points_in_camera) const;
};

struct OrbitOptions {
  double yaw_deg = 90;       ///< about `up`; 90: seen from the person's left when it faces the camera
  double elevation_deg = 0;  ///< positive: from above
  double margin_m = 0.22;    ///< margin around the points, as the body extends beyond the joints
  Eigen::Vector3d up_in_camera = -Eigen::Vector3d::UnitY();
};

/// A pinhole view rotated about the centre of all `points` (each n×3, video camera's frame, metres; rows that are not
/// finite are ignored), as near as possible with every point in the image. Throws std::invalid_argument when no point
/// is finite.
View OrbitView(const std::vector<MatrixX3d>& points, int width, int height, const OrbitOptions& options);

}  // namespace bodyloom
