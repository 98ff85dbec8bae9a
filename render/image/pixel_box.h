// SPDX-License-Identifier: Apache-2.0
/// A half-open rectangle of pixels [x_begin, x_end) × [y_begin, y_end).
#pragma once

#include <algorithm>
#include <cstddef>

namespace bodyloom {

struct PixelBox {
  int x_begin = 0, y_begin = 0, x_end = 0, y_end = 0;

  [[nodiscard]] bool empty() const { return x_end <= x_begin || y_end <= y_begin; }
  [[nodiscard]] int width() const { return empty() ? 0 : x_end - x_begin; }
  [[nodiscard]] int height() const { return empty() ? 0 : y_end - y_begin; }
  [[nodiscard]] size_t area() const { return size_t(width()) * size_t(height()); }
  [[nodiscard]] bool Contains(int x, int y) const { return x >= x_begin && x < x_end && y >= y_begin && y < y_end; }
  /// Row-major index of a pixel of the box.
  [[nodiscard]] size_t IndexOf(int x, int y) const { return size_t(y - y_begin) * width() + size_t(x - x_begin); }
  [[nodiscard]] PixelBox GrownBy(int pixels) const {
    return {x_begin - pixels, y_begin - pixels, x_end + pixels, y_end + pixels};
  }
  [[nodiscard]] PixelBox ClippedTo(const PixelBox& other) const {
    return {std::max(x_begin, other.x_begin), std::max(y_begin, other.y_begin), std::min(x_end, other.x_end),
            std::min(y_end, other.y_end)};
  }
};

}  // namespace bodyloom
