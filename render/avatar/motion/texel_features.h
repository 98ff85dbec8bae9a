// SPDX-License-Identifier: Apache-2.0
/// A square map of features over the UV atlas: the channels of a texel side by side, with a border of zeros around the map.
#pragma once

#include <cstddef>

#include "bodyloom/geometry/aligned_floats.h"

namespace bodyloom {

class TexelFeatures {
 public:
  TexelFeatures() = default;
  TexelFeatures(int side, int channels) { Resize(side, channels); }

  /// Of another size than before: all zero. Of the same: as it was.
  void Resize(int side, int channels) {
    if (side == side_ && channels == channels_) return;
    side_ = side, channels_ = channels;
    values_ = ZeroFloats(static_cast<size_t>(side + 2) * row_stride());
  }

  [[nodiscard]] int side() const { return side_; }
  [[nodiscard]] int channels() const { return channels_; }
  /// Floats from one row to the next.
  [[nodiscard]] ptrdiff_t row_stride() const { return static_cast<ptrdiff_t>(side_ + 2) * channels_; }
  /// The channels of the texel of a row and a column, both −1 to side(). Those of the border must stay zero.
  [[nodiscard]] float* at(int row, int column) {
    return values_.get() + (row + 1) * row_stride() + static_cast<ptrdiff_t>(column + 1) * channels_;
  }
  [[nodiscard]] const float* at(int row, int column) const {
    return values_.get() + (row + 1) * row_stride() + static_cast<ptrdiff_t>(column + 1) * channels_;
  }

 private:
  int side_ = 0, channels_ = 0;
  AlignedFloats values_;
};

}  // namespace bodyloom
