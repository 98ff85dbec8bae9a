// SPDX-License-Identifier: Apache-2.0
/// Dense kernels of the chain solver on row-major arrays of double, without Eigen, because they are compiled once per
/// instruction set and the best one is selected at run time (as geometry/body/skinning_simd.h).
///
/// All widths are multiples of kPanelStep and all padding holds zeros (or any finite values where it is not read).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bodyloom::panel_internal {

inline constexpr int kPanelStep = 8;
constexpr int RoundUp(int n) { return (n + kPanelStep - 1) / kPanelStep * kPanelStep; }
/// Row stride for this many columns: an odd number of cache lines, so that the rows of a strip of columns spread over
/// the whole first-level cache.
constexpr int RowStride(int columns) {
  return (RoundUp(columns) / kPanelStep % 2 == 1) ? RoundUp(columns) : RoundUp(columns) + kPanelStep;
}

/// C(i, j) += sign · Σ_{m = first}^{last−1} A(m, i) B(m, j) for i < rows, j < columns. `columns` is rounded up.
/// With `upper`, entries with j < i rounded down to kPanelStep are left alone: A and B start at the same column.
struct Products {
  const double* a = nullptr;
  const double* b = nullptr;
  double* c = nullptr;
  int64_t lda = 0, ldb = 0, ldc = 0;
  int rows = 0, columns = 0, first = 0, last = 0;
  bool upper = false;
  /// B is lower triangular in blocks of three: B(m, j) = 0 for m < 3⌊j/3⌋; those products are skipped.
  bool b_lower = false;
  /// −1 or +1.
  double sign = 1;
};
void AddProducts(const Products& products);

/// Eliminates the `pivots` leading columns of a symmetric front whose rows 0…pivots−1 are given:
///   [A | X | Z] with A pivots×pivots (upper triangle read) → [U | U⁻ᵀX | U⁻ᵀZ], UᵀU = A.
/// A takes RoundUp(pivots) columns, X x_columns (a multiple of kPanelStep), and Z RoundUp(pivots) more when has_lower:
/// Z and U⁻ᵀZ are lower triangular in blocks of three. Returns false when A is not positive definite.
bool EliminateRows(double* panel, int64_t stride, int pivots, int x_columns, bool has_lower);

/// Σ a_i b_i.
double Dot(const double* a, const double* b, int n);

/// Instruction sets of this build that this machine supports, best first. For tests: ForceSimdTarget() restricts the
/// kernels to one of them; 0 ends the restriction.
std::vector<int64_t> SimdTargets();
std::string SimdTargetName(int64_t target);
void ForceSimdTarget(int64_t target);

}  // namespace bodyloom::panel_internal
