// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/ssim_rows_simd.h"

// Instruction sets that add nothing to these loops, and those whose vectors have no size at compile time.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "data_tools/evaluation/ssim_rows_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bodyloom::ssim_internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, 8>;

/// Σ_t w_t value(t) for mirrored weights; value(t) is a vector.
template <typename Value>
HWY_INLINE hn::Vec<Tag> Mirrored(Tag d, const double* HWY_RESTRICT half, const Value& value) {
  hn::Vec<Tag> sum = hn::Mul(hn::Set(d, half[kRadius]), value(kRadius));
  for (int t = 0; t < kRadius; ++t) {
    sum = hn::MulAdd(hn::Set(d, half[t]), hn::Add(value(t), value(2 * kRadius - t)), sum);
  }
  return sum;
}

void FilterAlong(const double* HWY_RESTRICT a, const double* HWY_RESTRICT b, const double* HWY_RESTRICT half, int n,
                 double* HWY_RESTRICT out) {
  const Tag d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  HWY_ALIGN double squares[kWide], products[kWide];
  for (int x = 0; x < n + 2 * kRadius; x += lanes) {
    const auto u = hn::LoadU(d, a + x), v = hn::LoadU(d, b + x);
    hn::StoreU(hn::Add(hn::Mul(u, u), hn::Mul(v, v)), d, squares + x);
    hn::StoreU(hn::Mul(u, v), d, products + x);
  }
  const double* const moments[kMoments] = {a, b, squares, products};
  for (int m = 0; m < kMoments; ++m) {
    const double* HWY_RESTRICT in = moments[m];
    for (int x = 0; x < n; x += lanes) {
      hn::StoreU(Mirrored(d, half, [&](int t) { return hn::LoadU(d, in + x + t); }), d, out + m * kPitch + x);
    }
  }
}

void SsimAcross(const double* const* HWY_RESTRICT lines, const double* HWY_RESTRICT half, const Constants& constants,
                int n, double* HWY_RESTRICT ssim) {
  const Tag d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto c1 = hn::Set(d, constants.c1), c2 = hn::Set(d, constants.c2), two = hn::Set(d, 2);
  const auto norm = hn::Set(d, constants.covariance_norm);
  for (int x = 0; x < n; x += lanes) {
    const auto mean = [&](int m) {
      return Mirrored(d, half, [&](int t) { return hn::LoadU(d, lines[t] + m * kPitch + x); });
    };
    const auto mean_a = mean(0), mean_b = mean(1);
    const auto product = hn::Mul(mean_a, mean_b);
    const auto squares = hn::Add(hn::Mul(mean_a, mean_a), hn::Mul(mean_b, mean_b));
    const auto variances = hn::Mul(norm, hn::Sub(mean(2), squares));
    const auto covariance = hn::Mul(norm, hn::Sub(mean(3), product));
    const auto above = hn::Mul(hn::Add(hn::Mul(two, product), c1), hn::Add(hn::Mul(two, covariance), c2));
    const auto below = hn::Mul(hn::Add(squares, c1), hn::Add(variances, c2));
    hn::StoreU(hn::Div(above, below), d, ssim + x);
  }
}

}  // namespace bodyloom::ssim_internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bodyloom::ssim_internal {

HWY_EXPORT(FilterAlong);
HWY_EXPORT(SsimAcross);

void FilterAlong(const double* a, const double* b, const double* half, int n, double* out) {
  HWY_DYNAMIC_DISPATCH(FilterAlong)(a, b, half, n, out);
}

void SsimAcross(const double* const* lines, const double* half, const Constants& constants, int n, double* ssim) {
  HWY_DYNAMIC_DISPATCH(SsimAcross)(lines, half, constants, n, ssim);
}

std::vector<int64_t> SimdTargets() { return hwy::SupportedAndGeneratedTargets(); }

void ForceSimdTarget(int64_t target) { hwy::SetSupportedTargetsForTest(target); }

}  // namespace bodyloom::ssim_internal
#endif  // HWY_ONCE
