// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/panel_simd.h"

#include <cmath>

// Instruction sets that add nothing to these loops, and those whose vectors have no size at compile time.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracking/problem/panel_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bodyloom::panel_internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, kPanelStep>;

/// kRows × (kVectors registers) of C in registers over the whole depth.
template <int kRows, int kVectors>
HWY_INLINE void Tile(const Products& p, int first, int i, int j) {
  const Tag d;
  const int N = static_cast<int>(hn::Lanes(d));
  const double* HWY_RESTRICT a = p.a + i;
  const double* HWY_RESTRICT b = p.b + j;
  hn::Vec<Tag> sum[kRows][kVectors];
  HWY_UNROLL(4)
  for (int r = 0; r < kRows; ++r) {
    HWY_UNROLL(3)
    for (int v = 0; v < kVectors; ++v) sum[r][v] = hn::Zero(d);
  }
  for (int m = first; m < p.last; ++m) {
    const double* HWY_RESTRICT am = a + m * p.lda;
    const double* HWY_RESTRICT bm = b + m * p.ldb;
    hn::Vec<Tag> x[kVectors];
    HWY_UNROLL(3)
    for (int v = 0; v < kVectors; ++v) x[v] = hn::LoadU(d, bm + v * N);
    HWY_UNROLL(4)
    for (int r = 0; r < kRows; ++r) {
      const auto y = hn::Set(d, am[r]);
      HWY_UNROLL(3)
      for (int v = 0; v < kVectors; ++v) sum[r][v] = hn::MulAdd(y, x[v], sum[r][v]);
    }
  }
  const auto sign = hn::Set(d, p.sign);
  HWY_UNROLL(4)
  for (int r = 0; r < kRows; ++r) {
    double* HWY_RESTRICT c = p.c + (i + r) * p.ldc + j;
    HWY_UNROLL(3)
    for (int v = 0; v < kVectors; ++v) {
      hn::StoreU(hn::MulAdd(sign, sum[r][v], hn::LoadU(d, c + v * N)), d, c + v * N);
    }
  }
}

template <int kVectors>
HWY_INLINE void Strip(const Products& p, int first, int j) {
  const Tag d;
  // The last row whose part right of the diagonal (rounded down) reaches this strip.
  const int end = j + kVectors * static_cast<int>(hn::Lanes(d));
  const int rows = p.upper && end < p.rows ? end : p.rows;
  int i = 0;
  for (; i + 4 <= rows; i += 4) Tile<4, kVectors>(p, first, i, j);
  switch (rows - i) {
    case 3:
      Tile<3, kVectors>(p, first, i, j);
      break;
    case 2:
      Tile<2, kVectors>(p, first, i, j);
      break;
    case 1:
      Tile<1, kVectors>(p, first, i, j);
      break;
    default:
      break;
  }
}

void AddAllStrips(const Products& p) {
  const Tag d;
  const int N = static_cast<int>(hn::Lanes(d));
  const int columns = RoundUp(p.columns);
  for (int j = 0; j < columns;) {
    const int vectors = (columns - j) / N;
    const int from = p.b_lower && j / 3 * 3 > p.first ? j / 3 * 3 : p.first;
    if (vectors >= 3) {
      Strip<3>(p, from, j);
      j += 3 * N;
    } else if (vectors == 2) {
      Strip<2>(p, from, j);
      j += 2 * N;
    } else {
      Strip<1>(p, from, j);
      j += N;
    }
  }
}

/// Factors `rows` rows that have been updated by all rows above; `from` and `end` bound the columns in use.
bool EliminateWithin(double* HWY_RESTRICT panel, int64_t stride, int row, int rows, int from, int end) {
  const Tag d;
  const int N = static_cast<int>(hn::Lanes(d));
  for (int r = row; r < row + rows; ++r) {
    double* HWY_RESTRICT p = panel + r * stride;
    const double pivot = p[r];
    if (!(pivot > 0) || !(pivot < 1e300)) return false;
    const auto scale = hn::Set(d, 1 / std::sqrt(pivot));
    for (int j = from; j < end; j += N) hn::StoreU(hn::Mul(scale, hn::LoadU(d, p + j)), d, p + j);
    for (int j = from; j < r; ++j) p[j] = 0;
    for (int q = r + 1; q < row + rows; ++q) {
      double* HWY_RESTRICT target = panel + q * stride;
      const auto factor = hn::Set(d, -p[q]);
      for (int j = from; j < end; j += N) {
        hn::StoreU(hn::MulAdd(factor, hn::LoadU(d, p + j), hn::LoadU(d, target + j)), d, target + j);
      }
    }
  }
  return true;
}

bool EliminateRows(double* panel, int64_t stride, int pivots, int x_columns, bool has_lower) {
  const int a_columns = RoundUp(pivots);
  for (int k = 0; k < pivots; k += 4) {
    const int rows = pivots - k < 4 ? pivots - k : 4;
    const int from = k / kPanelStep * kPanelStep;
    int end = a_columns + x_columns;
    Products p;
    p.a = panel + k;
    p.b = panel + from;
    p.c = panel + k * stride + from;
    p.lda = p.ldb = p.ldc = stride;
    p.rows = rows;
    p.columns = end - from;
    p.last = k;
    p.sign = -1;
    AddAllStrips(p);
    if (has_lower) {
      p.b = panel + end;
      p.c = panel + k * stride + end;
      p.columns = RoundUp((k + rows - 1) / 3 * 3 + 3);
      p.b_lower = true;
      AddAllStrips(p);
      end += p.columns;
    }
    if (!EliminateWithin(panel, stride, k, rows, from, end)) return false;
  }
  return true;
}

double Dot(const double* HWY_RESTRICT a, const double* HWY_RESTRICT b, int n) {
  const Tag d;
  const int N = static_cast<int>(hn::Lanes(d));
  auto even = hn::Zero(d), odd = hn::Zero(d);
  int i = 0;
  for (; i + 2 * N <= n; i += 2 * N) {
    even = hn::MulAdd(hn::LoadU(d, a + i), hn::LoadU(d, b + i), even);
    odd = hn::MulAdd(hn::LoadU(d, a + i + N), hn::LoadU(d, b + i + N), odd);
  }
  for (; i + N <= n; i += N) even = hn::MulAdd(hn::LoadU(d, a + i), hn::LoadU(d, b + i), even);
  double sum = hn::GetLane(hn::SumOfLanes(d, hn::Add(even, odd)));
  for (; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace bodyloom::panel_internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bodyloom::panel_internal {

HWY_EXPORT(AddAllStrips);
HWY_EXPORT(EliminateRows);
HWY_EXPORT(Dot);

void AddProducts(const Products& products) { HWY_DYNAMIC_DISPATCH(AddAllStrips)(products); }

bool EliminateRows(double* panel, int64_t stride, int pivots, int x_columns, bool has_lower) {
  return HWY_DYNAMIC_DISPATCH(EliminateRows)(panel, stride, pivots, x_columns, has_lower);
}

double Dot(const double* a, const double* b, int n) { return HWY_DYNAMIC_DISPATCH(Dot)(a, b, n); }

std::vector<int64_t> SimdTargets() { return hwy::SupportedAndGeneratedTargets(); }

std::string SimdTargetName(int64_t target) { return hwy::TargetName(target); }

void ForceSimdTarget(int64_t target) { hwy::SetSupportedTargetsForTest(target); }

}  // namespace bodyloom::panel_internal
#endif  // HWY_ONCE
