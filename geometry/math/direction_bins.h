// SPDX-License-Identifier: Apache-2.0
/// Bins unit directions into nearly equal areas: by the nearest of the points of a Fibonacci sphere.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace bodyloom {

class DirectionBins {
 public:
  /// n >= 2 bins. Point i has z = 1 − (2i+1)/n and longitude i·π(3−√5).
  explicit DirectionBins(int n);
  [[nodiscard]] int size() const { return static_cast<int>(points_.size()); }
  [[nodiscard]] const Eigen::Vector3d& direction(int i) const { return points_[i]; }
  /// Index of the bin nearest to `direction` (any non-zero length), within a bin's width: looked up in a cube map of
  /// 6×24² cells whose centres are exact. Zero or NaN gives bin 0.
  [[nodiscard]] int Nearest(const Eigen::Vector3d& direction) const;

 private:
  std::vector<Eigen::Vector3d> points_;
  std::vector<int> cube_;
};

}  // namespace bodyloom
