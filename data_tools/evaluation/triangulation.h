// SPDX-License-Identifier: Apache-2.0
/// A point from the pixels at which several calibrated cameras saw it.
#pragma once

#include <Eigen/Core>
#include <span>

#include "bodyloom/geometry/camera.h"

namespace bodyloom {

/// One camera's view of a point. Borrowed pointers.
struct Sighting {
  const Camera* camera = nullptr;    ///< pinhole
  const CameraPose* pose = nullptr;  ///< camera from world
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

struct TriangulatedPoint {
  bool is_valid = false;  ///< two or more rays that meet at more than 1°, the point in front of every camera
  Eigen::Vector3d point_in_world = Eigen::Vector3d::Zero();  ///< metres
  double rms_px = 0;                                         ///< distance of its projections to the pixels
};

/// argmin_X Σ_i ‖π_i(X) − pixel_i‖²: the point nearest to all rays (least squares), refined by Gauss–Newton on pixels.
/// Source: Hartley and Zisserman, "Multiple View Geometry", chapter 12.
TriangulatedPoint TriangulatePoint(std::span<const Sighting> sightings);

}  // namespace bodyloom
