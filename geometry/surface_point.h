// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace bodyloom {

/// A point of the surface: Σ_c barycentric_c · (corner c of the face).
struct SurfacePoint {
  int face = 0;
  Eigen::Vector3d barycentric = Eigen::Vector3d::UnitX();  ///< sums to 1 for a point in the face's plane
};

}  // namespace bodyloom
