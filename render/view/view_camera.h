// SPDX-License-Identifier: Apache-2.0
/// Cameras for pictures: a scaled copy of a camera, and a second camera that looks at the same people from the side.
#pragma once

#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"

namespace bodyloom {

/// The camera whose images are `factor` times as large: pixel' = factor · (pixel + ½) − ½, image size rounded.
Camera ScaledCamera(const Camera& camera, double factor);

/// Pixels that a metre across the view takes at a depth: fy / depth of a pinhole camera (0 up to Camera::kMinDepth),
/// the scale of a weak-perspective one.
double PixelsPerMetre(const Camera& camera, double depth_m);

/// A virtual camera and where it stands in the frame of the camera that took the video.
struct View {
  Camera camera;
  CameraPose from_camera;  ///< point_in_view = rotation · point_in_camera + translation
  /// Points of the video camera's frame in the view's frame (n×3).
  [[nodiscard]] MatrixX3d Apply(const MatrixX3d& points_in_camera) const;
};

struct OrbitOptions {
  double yaw_deg = 90;       ///< about `up`; 90: seen from the person's left when it faces the camera
  double elevation_deg = 0;  ///< positive: from above
  double margin_m = 0.22;    ///< room around the points, for the flesh around joints
  Eigen::Vector3d up_in_camera = -Eigen::Vector3d::UnitY();
};

/// A pinhole view turned about the middle of all `points` (each n×3, video camera's frame, metres; rows that are not
/// finite are ignored), as near as keeps every point in the image. Throws std::invalid_argument when no point is
/// finite.
View OrbitView(const std::vector<MatrixX3d>& points, int width, int height, const OrbitOptions& options);

}  // namespace bodyloom
