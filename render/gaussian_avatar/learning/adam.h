// SPDX-License-Identifier: Apache-2.0
/// Adam for tables of which only some rows are updated in a step: the Gaussians visible in the image.
///
/// Every row has its own step count n. With g its derivative, β₁ = 0.9, β₂ = 0.99:
///   m ← β₁ m + (1 − β₁) g,   v ← β₂ v + (1 − β₂) g²,   x ← x − rate · m/(1 − β₁ⁿ) / (sqrt(v/(1 − β₂ⁿ)) + 1e-15)
/// Rows that are not updated keep values and moments. Source: Kingma and Ba, "Adam", ICLR 2015.
///
/// Same bytes for any number of threads and any instruction set.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/splat/float_columns.h"

namespace bodyloom {

struct AdamState {
  FloatColumns first, second;  ///< m and v, shaped as the table
  std::vector<int32_t> steps;  ///< n, by row
  /// Sets zeros for a table of this size.
  void Reset(int num_columns, int num_rows);
  /// Resets a row.
  void Forget(int row);
};

/// Performs one step. `rates` per column; 0: the column stays. `moves` per row, 0 or 1. Throws std::invalid_argument
/// when sizes differ.
void AdamStep(const FloatColumns& gradient, std::span<const float> rates, std::span<const uint8_t> moves,
              int num_threads, AdamState* state, FloatColumns* values);

}  // namespace bodyloom
