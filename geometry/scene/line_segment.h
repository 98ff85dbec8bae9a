// SPDX-License-Identifier: Apache-2.0
/// A straight line segment of a picture: found by tracking/detection/line_segments.h, read by
/// tracking/room/picture_vertical.h.
#pragma once

#include <Eigen/Core>

namespace bodyloom {

/// Ends in pixels, in either order; pixel centres are at integer coordinates.
struct LineSegment {
  Eigen::Vector2d a = Eigen::Vector2d::Zero(), b = Eigen::Vector2d::Zero();
  [[nodiscard]] double length() const { return (b - a).norm(); }
};

}  // namespace bodyloom
