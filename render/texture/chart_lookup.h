// SPDX-License-Identifier: Apache-2.0
/// Surface points from chart coordinates: the inverse of ChartUvAt (render/raster/visible_points.h), as needed for
/// DensePose-style (part, u, v) labels.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "geometry/body/body_model.h"

namespace bodyloom {

/// Immutable after construction; may be shared by threads. Does not keep the body.
class ChartLookup {
 public:
  /// Throws std::invalid_argument when the body has no parts or no chart coordinates.
  explicit ChartLookup(const BodyModel& body);

  /// The point of part 1..24 at (u, v); where the chart does not cover (u, v), the covered point nearest to it in chart
  /// units, at the distance `gap` (may be null; 0 inside). Of equally near faces the lowest index is taken. Weights are
  /// in [0, 1]. Face −1 for a part that the body lacks or coordinates that are not finite.
  [[nodiscard]] SurfacePoint Find(int part, const Eigen::Vector2d& uv, double* gap = nullptr) const;

 private:
  static constexpr int kCells = 32;  ///< per side, over the chart's box
  struct Triangle {
    int face;
    std::array<Eigen::Vector2d, 3> corners;
  };
  struct Chart {
    std::vector<Triangle> triangles;
    Eigen::Vector2d low = Eigen::Vector2d::Zero(), cell = Eigen::Vector2d::Ones();
    std::vector<int> begin, entries;  ///< triangles whose box meets a cell, by cell
  };
  std::array<Chart, 25> charts_;
};

}  // namespace bodyloom
