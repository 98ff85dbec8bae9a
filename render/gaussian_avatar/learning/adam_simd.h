// SPDX-License-Identifier: Apache-2.0
/// The inner loop of render/gaussian_avatar/learning/adam.h over one column. The same bits on every instruction set.
#pragma once

namespace bodyloom::avatar_internal {

struct AdamColumn {
  const float* gradient = nullptr;
  const float* moves = nullptr;    ///< 1 or 0, by row: rows with 0 stay unchanged
  const float* unbias1 = nullptr;  ///< 1/(1 − β₁ⁿ) of the row's n steps
  const float* unbias2 = nullptr;  ///< 1/sqrt(1 − β₂ⁿ)
  float *first = nullptr, *second = nullptr, *value = nullptr;
  float rate = 0;
};

inline constexpr int kAdamLanes = 16;
inline constexpr float kAdamBeta1 = 0.9F, kAdamBeta2 = 0.99F, kAdamEpsilon = 1e-15F;

/// Rows first to last − 1, both multiples of kAdamLanes.
void StepAdamColumn(const AdamColumn& column, int first, int last);

}  // namespace bodyloom::avatar_internal
