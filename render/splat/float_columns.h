// SPDX-License-Identifier: Apache-2.0
/// A table of floats stored column after column, as SIMD loops want it, that keeps its memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "geometry/math/arrays.h"

namespace bodyloom {

/// Columns begin at a cache line and end in spare rows up to a multiple of kLanes, which kernels may read and write.
class FloatColumns {
 public:
  static constexpr int kLanes = 16;  ///< rows that a kernel may take at once

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

  /// Makes room; memory is taken only when there is too little, and then all values are zero. Otherwise they stay as
  /// they lie, which is in place only when the sizes are those of before.
  void Resize(int num_columns, int num_rows) {
    columns_ = num_columns, rows_ = num_rows;
    // An odd number of cache lines: with a power of two all columns would share one set of the cache.
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
  /// Floats from one column to the next.
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
