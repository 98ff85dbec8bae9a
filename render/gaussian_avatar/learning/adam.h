// SPDX-License-Identifier: Apache-2.0
/// Adam for tables in which only some rows have a say in a step: the Gaussians in the picture.
///
/// A row counts its own n steps. With g its derivative, β₁ = 0.9, β₂ = 0.99:
///   m ← β₁ m + (1 − β₁) g,   v ← β₂ v + (1 − β₂) g²,   x ← x − rate · m/(1 − β₁ⁿ) / (sqrt(v/(1 − β₂ⁿ)) + 1e-15)
/// Rows that do not move keep value and moments. Source: Kingma and Ba, "Adam", ICLR 2015.
///
/// Same bytes for any number of threads and any instruction set.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/splat/float_columns.h"

namespace bodyloom {

struct AdamState {
  FloatColumns first, second;  ///< m and v, as the table
  std::vector<int32_t> steps;  ///< n, by row
  /// Zeros for a table of this size.
  void Reset(int num_columns, int num_rows);
  /// A row that begins anew.
  void Forget(int row);
};

/// `rates` by column; 0: the column stays. `moves` by row, 0 or 1. Throws std::invalid_argument when sizes differ.
void AdamStep(const FloatColumns& gradient, std::span<const float> rates, std::span<const uint8_t> moves,
              int num_threads, AdamState* state, FloatColumns* values);

}  // namespace bodyloom
