// SPDX-License-Identifier: Apache-2.0
/// Single-precision matrix product of the lifter: plain arrays without Eigen, compiled once per instruction set and
/// selected at run time (as tracking/problem/panel_simd.h).
#pragma once

#include <cstdint>

namespace bodyloom::matrix_internal {

/// C(i, j) += Σ_k A(i, k) B(j, k) for i < rows, j < columns, k < depth; all row-major with strides. Sums are taken in
/// an order that depends only on the instruction set: a row's numbers do not depend on its neighbours.
void AddTimesTransposed(const float* a, int64_t lda, int rows, const float* b, int64_t ldb, int columns, int depth,
                        float* c, int64_t ldc);

}  // namespace bodyloom::matrix_internal
