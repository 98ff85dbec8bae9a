// SPDX-License-Identifier: Apache-2.0
/// Error of descriptor maps against the surface that they describe.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

struct MapError {
  double normal_deg = 0;     ///< mean angle
  double velocity_mm_s = 0;  ///< root mean square of the vector's difference
};

/// The truth at the middle of every tenth face: the unit normal (interpolated from its vertices, as maps do) and the
/// velocity of the surface by the body model's derivative at central differences of the true poses.
class MapTruth {
 public:
  MapTruth(const BodyModel& body, const Track& truth);
  /// Maps [N(3), V(3)] of size² texels, one record a frame of the truth, looked up bilinearly at the faces' middles.
  [[nodiscard]] MapError ErrorOf(const std::string& npy_path, int size) const;

 private:
  std::vector<Eigen::Vector2d> uv_;                    ///< one a face
  std::vector<std::vector<Eigen::Vector3d>> normals_;  ///< T of one a face
  std::vector<std::vector<Eigen::Vector3d>> velocities_;
};

}  // namespace bodyloom
