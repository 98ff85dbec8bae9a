// SPDX-License-Identifier: Apache-2.0
/// A column-major table of floats for SIMD loops that reuses its memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "geometry/math/arrays.h"

namespace bodyloom {

/// Columns are aligned to cache lines and padded with spare rows to a multiple of kLanes, which kernels may access.
class FloatColumns {
 public:
  static constexpr int kLanes = 16;  ///< rows that a kernel may process at once

  FloatColumns() = default;
  FloatColumns(int num_columns, int num_rows) { Resize(num_columns, num_rows); }
  FloatColumns(const FloatColumns& other) { *this = other; }
  FloatColumns(FloatColumns&&) noexcept = default;
  FloatColumns& operator=(FloatColumns&&) noexcept = default;
  FloatColumns& operator=(const FloatColumns& other) {
    Resize(other.columns_, other.rows_);
    if (this != &other) std::copy_n(other.data(), stride_ * columns_, data());
    return *this;
  }
  ~FloatColumns() = default;

  /// Resizes the table. All values are zero when memory is allocated. Otherwise memory is not touched, so values keep
  /// their places only if the sizes are unchanged.
  void Resize(int num_columns, int num_rows) {
    columns_ = num_columns, rows_ = num_rows;
    // An odd number of cache lines: with a power of two all columns would map to one cache set.
    const size_t lines = (static_cast<size_t>(num_rows) + kLanes - 1) / kLanes;
    stride_ = (lines | 1) * kLanes;
    const size_t size = stride_ * num_columns;
    if (size > capacity_) {
      capacity_ = 0;
      values_.reset();
      values_ = ZeroFloats(size);
      capacity_ = size;
    }
  }
  void Fill(float value) { std::fill_n(data(), stride_ * columns_, value); }

  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int columns() const { return columns_; }
  /// Distance between columns, in floats.
  [[nodiscard]] size_t stride() const { return stride_; }
  [[nodiscard]] float* data() { return values_.get(); }
  [[nodiscard]] const float* data() const { return values_.get(); }
  [[nodiscard]] float* column(int c) { return values_.get() + stride_ * c; }
  [[nodiscard]] const float* column(int c) const { return values_.get() + stride_ * c; }
  [[nodiscard]] std::span<float> values(int c) { return {column(c), static_cast<size_t>(rows_)}; }
  [[nodiscard]] std::span<const float> values(int c) const { return {column(c), static_cast<size_t>(rows_)}; }
  [[nodiscard]] float& operator()(int row, int c) { return column(c)[row]; }
  [[nodiscard]] float operator()(int row, int c) const { return column(c)[row]; }

 private:
  int columns_ = 0, rows_ = 0;
  size_t stride_ = 0, capacity_ = 0;
  AlignedFloats values_;
};

}  // namespace bodyloom
