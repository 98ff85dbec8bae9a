// SPDX-License-Identifier: Apache-2.0
#include "geometry/math/direction_bins.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int kCells = 24;  // along each edge of the cube

int Exact(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& direction) {
  int best = 0;
  for (size_t i = 1; i < points.size(); ++i) {
    if (points[i].dot(direction) > points[best].dot(direction)) best = static_cast<int>(i);
  }
  return best;
}

}  // namespace

DirectionBins::DirectionBins(int n) {
  BODYLOOM_CHECK(n >= 2, "direction bins: ", n, ", expected at least 2");
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < n; ++i) {
    const double z = 1 - (2.0 * i + 1) / n, radius = std::sqrt(1 - z * z);
    points_.emplace_back(radius * std::cos(golden * i), radius * std::sin(golden * i), z);
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      for (int r = 0; r < kCells; ++r) {
        for (int c = 0; c < kCells; ++c) {
          Eigen::Vector3d d;
          d[axis] = side == 0 ? 1 : -1;
          d[(axis + 1) % 3] = 2 * (r + 0.5) / kCells - 1;
          d[(axis + 2) % 3] = 2 * (c + 0.5) / kCells - 1;
          cube_.push_back(Exact(points_, d));
        }
      }
    }
  }
}

int DirectionBins::Nearest(const Eigen::Vector3d& direction) const {
  Eigen::Index axis;
  const double largest = direction.cwiseAbs().maxCoeff(&axis);
  if (!(largest > 0) || !std::isfinite(largest)) return 0;
  const int side = direction[axis] > 0 ? 0 : 1;
  const auto cell = [&](Eigen::Index k) {
    return std::clamp(static_cast<int>((direction[k % 3] / largest + 1) / 2 * kCells), 0, kCells - 1);
  };
  return cube_[((axis * 2 + side) * kCells + cell(axis + 1)) * kCells + cell(axis + 2)];
}

}  // namespace bodyloom
