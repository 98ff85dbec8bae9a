// SPDX-License-Identifier: Apache-2.0
/// Marks on a floor that show at a glance whether a body stands on it, hovers or is below it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "render/image/image.h"
#include "render/view/floor.h"

namespace bodyloom {

/// Surface up to this far above or below the floor touches it, metres: what a sole gives way and a fit is uncertain.
inline constexpr double kTouchesFloorM = 0.02;

struct FloorContact {
  double lowest_m = 0;                               ///< height of the lowest vertex over the floor, < 0: below it
  Eigen::Vector3d lowest = Eigen::Vector3d::Zero();  ///< that vertex
  std::vector<Eigen::Vector3d> touching;             ///< on the floor, below the parts that touch it, at most 12
};

/// Finds where a body (vertices in the camera frame, at least one) touches a floor: its lowest vertex, then the lowest
/// one that is 12 cm from it along the floor, and so on, those of them within kTouchesFloorM of the floor. A standing
/// foot has two: ball and heel.
FloorContact ContactWithFloor(const MatrixX3d& vertices, const Floor& floor);

/// Draws a green disc, 4 cm in radius, where the body touches the floor. Where its lowest point does not, a line from
/// there straight to the floor, and its height in cm ("12 cm", letters cap_px high): dark above the floor, red below.
void DrawFloorContact(const FloorContact& contact, const Floor& floor, const Camera& camera, double cap_px,
                      Image* image);

}  // namespace bodyloom
