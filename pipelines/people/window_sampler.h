// SPDX-License-Identifier: Apache-2.0
/// Samples of the window around a person at the pixels of a picture of the same shape, as large or larger.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "bodyloom/render/person_window.h"

namespace bodyloom {

class WindowSampler {
 public:
  /// Of frame t's window, for a picture of picture_width × picture_height pixels.
  WindowSampler(const PersonWindow& window, int t, int picture_width, int picture_height);

  /// Rows or columns that no pixel of the window reaches.
  [[nodiscard]] bool RowIsOutside(int y) const { return rows_[y].first < -1 || rows_[y].first >= height_; }
  [[nodiscard]] bool ColumnIsOutside(int x) const { return columns_[x].first < -1 || columns_[x].first >= width_; }

  /// A plane of the window's pixels, interpolated between the four nearest to the picture's pixel (x, y); 0 outside the
  /// window. Exact where nothing is enlarged.
  [[nodiscard]] float At(std::span<const float> plane, int x, int y) const;

  /// Index of the window's pixel nearest to the picture's pixel (x, y), −1 outside the window.
  [[nodiscard]] int Nearest(int x, int y) const;

 private:
  /// Where a row or column of the picture lies between two of the window's.
  struct Between {
    int first = 0;
    float to_second = 0;
  };
  static std::vector<Between> Places(int count, double scale, int corner);

  int width_, height_;
  std::vector<Between> columns_, rows_;
};

}  // namespace bodyloom
