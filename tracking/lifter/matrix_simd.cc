// SPDX-License-Identifier: Apache-2.0
#include "tracking/lifter/matrix_simd.h"

// Instruction sets that add nothing to these loops, and those whose vectors have no size at compile time.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracking/lifter/matrix_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bodyloom::matrix_internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, 16>;

/// kRows rows of A against kColumns rows of B.
template <int kRows, int kColumns>
HWY_INLINE void Tile(const float* a, int64_t lda, const float* b, int64_t ldb, int depth, float* c, int64_t ldc) {
  const Tag d;
  const int N = static_cast<int>(hn::Lanes(d));
  hn::Vec<Tag> sum[kRows][kColumns];
  HWY_UNROLL(4)
  for (int r = 0; r < kRows; ++r) {
    HWY_UNROLL(4)
    for (int q = 0; q < kColumns; ++q) sum[r][q] = hn::Zero(d);
  }
  int k = 0;
  for (; k + N <= depth; k += N) {
    hn::Vec<Tag> y[kColumns];
    HWY_UNROLL(4)
    for (int q = 0; q < kColumns; ++q) y[q] = hn::LoadU(d, b + q * ldb + k);
    HWY_UNROLL(4)
    for (int r = 0; r < kRows; ++r) {
      const auto x = hn::LoadU(d, a + r * lda + k);
      HWY_UNROLL(4)
      for (int q = 0; q < kColumns; ++q) sum[r][q] = hn::MulAdd(x, y[q], sum[r][q]);
    }
  }
  for (int r = 0; r < kRows; ++r) {
    for (int q = 0; q < kColumns; ++q) {
      float value = hn::GetLane(hn::SumOfLanes(d, sum[r][q]));
      for (int m = k; m < depth; ++m) value += a[r * lda + m] * b[q * ldb + m];
      c[r * ldc + q] += value;
    }
  }
}

template <int kColumns>
HWY_INLINE void Strip(const float* a, int64_t lda, int rows, const float* b, int64_t ldb, int depth, float* c,
                      int64_t ldc) {
  int r = 0;
  for (; r + 4 <= rows; r += 4) Tile<4, kColumns>(a + r * lda, lda, b, ldb, depth, c + r * ldc, ldc);
  for (; r < rows; ++r) Tile<1, kColumns>(a + r * lda, lda, b, ldb, depth, c + r * ldc, ldc);
}

void AddAllTiles(const float* a, int64_t lda, int rows, const float* b, int64_t ldb, int columns, int depth, float* c,
                 int64_t ldc) {
  int j = 0;
  for (; j + 4 <= columns; j += 4) Strip<4>(a, lda, rows, b + j * ldb, ldb, depth, c + j, ldc);
  for (; j < columns; ++j) Strip<1>(a, lda, rows, b + j * ldb, ldb, depth, c + j, ldc);
}

}  // namespace bodyloom::matrix_internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bodyloom::matrix_internal {

HWY_EXPORT(AddAllTiles);

void AddTimesTransposed(const float* a, int64_t lda, int rows, const float* b, int64_t ldb, int columns, int depth,
                        float* c, int64_t ldc) {
  HWY_DYNAMIC_DISPATCH(AddAllTiles)(a, lda, rows, b, ldb, columns, depth, c, ldc);
}

}  // namespace bodyloom::matrix_internal
#endif  // HWY_ONCE
