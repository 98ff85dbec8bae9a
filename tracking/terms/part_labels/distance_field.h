// SPDX-License-Identifier: Apache-2.0
/// Signed distance in pixels to the boundary of a region of an image: negative inside, zero half way between the last
/// pixel inside and the first outside, smooth (C¹) between.
///
/// The distance is exact (Euclidean, all pixels) at the nodes of a grid of `cell_px`, and interpolated by Catmull–Rom
/// cubics between them, so that a field costs little memory and has the exact derivative of what it returns. Beyond the
/// grid: the value at the nearest point of the grid's rectangle plus the distance to it.
/// Source: Felzenszwalb & Huttenlocher, "Distance transforms of sampled functions" (lower envelope of parabolas).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

namespace bodyloom {

class DistanceField {
 public:
  enum class Pixel : uint8_t {
    kOutside,
    kInside,
    /// Belongs to neither: distance to the inside minus distance to the outside, so the boundary runs half way.
    kUnknown,
  };

  /// Region of the pixels that `fill_row(y, row)` marks kInside; it writes the `width` pixels from (x_begin, y) on. The
  /// grid covers the rectangle of width × height pixels from (x_begin, y_begin); pixels outside it are not used.
  /// `cell_px` at least 1. Without a pixel inside (or outside) the distance to it counts as the rectangle's diagonal.
  DistanceField(int x_begin, int y_begin, int width, int height, int cell_px,
                const std::function<void(int y, Pixel* row)>& fill_row);

  /// Distance at any finite position, with its derivative when requested.
  double Evaluate(const Eigen::Vector2d& pixel, Eigen::RowVector2d* gradient = nullptr) const;

 private:
  [[nodiscard]] float Node(int column, int row) const;

  int x_begin_, y_begin_, cell_px_, columns_, rows_;
  std::vector<float> nodes_;
};

}  // namespace bodyloom
