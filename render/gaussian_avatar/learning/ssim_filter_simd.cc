// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/learning/ssim_filter_simd.h"

#include <cmath>

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/gaussian_avatar/learning/ssim_filter_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bodyloom::avatar_internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using DS = hn::CappedTag<float, kSsimLanes>;
using VS = hn::Vec<DS>;

constexpr int kStep = static_cast<int>(hn::MaxLanes(DS()));

HWY_INLINE int WholeLanes(int n) { return (n + kSsimLanes - 1) / kSsimLanes * kSsimLanes; }

/// Σ_t w_t value(t) for mirrored weights.
template <class Value>
HWY_INLINE VS Windowed(const float* HWY_RESTRICT half, const Value& value) {
  const DS d;
  VS sum = hn::Mul(hn::Set(d, half[0]), value(kSsimRadius));
  for (int t = 1; t <= kSsimRadius; ++t) {
    sum = hn::Add(sum, hn::Mul(hn::Set(d, half[t]), hn::Add(value(kSsimRadius - t), value(kSsimRadius + t))));
  }
  return sum;
}

void FilterSsimRow(const float* HWY_RESTRICT in, const float* HWY_RESTRICT half, int n, float* HWY_RESTRICT out) {
  const DS d;
  const int end = WholeLanes(n);
  for (int x = 0; x < end; x += kStep) {
    hn::StoreU(Windowed(half, [&](int t) { return hn::LoadU(d, in + x + t - kSsimRadius); }), d, out + x);
  }
}

void FilterSsimColumn(const float* const* HWY_RESTRICT lines, const float* HWY_RESTRICT half, int n,
                      float* HWY_RESTRICT out) {
  const DS d;
  const int end = WholeLanes(n);
  for (int x = 0; x < end; x += kStep) {
    hn::StoreU(Windowed(half, [&](int t) { return hn::LoadU(d, lines[t] + x); }), d, out + x);
  }
}

void SsimProducts(const float* HWY_RESTRICT a, const float* HWY_RESTRICT b, int n, float* HWY_RESTRICT squares,
                  float* HWY_RESTRICT products) {
  const DS d;
  const int end = WholeLanes(n);
  for (int x = 0; x < end; x += kStep) {
    const VS u = hn::LoadU(d, a + x), v = hn::LoadU(d, b + x);
    hn::StoreU(hn::Add(hn::Mul(u, u), hn::Mul(v, v)), d, squares + x);
    hn::StoreU(hn::Mul(u, v), d, products + x);
  }
}

void SsimOfMoments(const float* const moments[4], int n, float* HWY_RESTRICT ssim, float* const by_moments[3]) {
  const DS d;
  const VS c1 = hn::Set(d, 1e-4F), c2 = hn::Set(d, 9e-4F), one = hn::Set(d, 1);
  const int end = WholeLanes(n);
  for (int x = 0; x < end; x += kStep) {
    const VS a = hn::LoadU(d, moments[0] + x), b = hn::LoadU(d, moments[1] + x);
    const VS squares = hn::Add(hn::Mul(a, a), hn::Mul(b, b)), product = hn::Mul(a, b);
    const VS covariance = hn::Sub(hn::LoadU(d, moments[3] + x), product);
    const VS top1 = hn::Add(hn::Add(product, product), c1), top2 = hn::Add(hn::Add(covariance, covariance), c2);
    const VS bottom1 = hn::Add(squares, c1);
    const VS bottom2 = hn::Add(hn::Sub(hn::LoadU(d, moments[2] + x), squares), c2);
    const VS inverse1 = hn::Div(one, bottom1), inverse2 = hn::Div(one, bottom2);
    const VS s = hn::Div(hn::Mul(top1, top2), hn::Mul(bottom1, bottom2));
    const VS inverse = hn::Mul(inverse1, inverse2);
    hn::StoreU(s, d, ssim + x);
    const VS twice_a = hn::Add(a, a), twice_b = hn::Add(b, b);
    const VS along = hn::Mul(hn::Mul(twice_b, hn::Sub(top2, top1)), inverse);
    hn::StoreU(hn::Sub(along, hn::Mul(hn::Mul(s, twice_a), hn::Sub(inverse1, inverse2))), d, by_moments[0] + x);
    hn::StoreU(hn::Neg(hn::Mul(s, inverse2)), d, by_moments[1] + x);
    hn::StoreU(hn::Mul(hn::Add(top1, top1), inverse), d, by_moments[2] + x);
  }
}

}  // namespace bodyloom::avatar_internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bodyloom::avatar_internal {

HWY_EXPORT(FilterSsimRow);
HWY_EXPORT(FilterSsimColumn);
HWY_EXPORT(SsimProducts);
HWY_EXPORT(SsimOfMoments);

std::array<float, kSsimRadius + 1> SsimWindow() {
  std::array<double, kSsimRadius + 1> weights{};
  double sum = 0;
  for (int t = 0; t <= kSsimRadius; ++t) {
    weights[t] = std::exp(-t * t / (2 * 1.5 * 1.5));
    sum += t == 0 ? weights[t] : 2 * weights[t];
  }
  std::array<float, kSsimRadius + 1> half{};
  for (int t = 0; t <= kSsimRadius; ++t) half[t] = static_cast<float>(weights[t] / sum);
  return half;
}

void FilterSsimRow(const float* in, const float* half, int n, float* out) {
  HWY_DYNAMIC_DISPATCH(FilterSsimRow)(in, half, n, out);
}
void FilterSsimColumn(const float* const* lines, const float* half, int n, float* out) {
  HWY_DYNAMIC_DISPATCH(FilterSsimColumn)(lines, half, n, out);
}
void SsimProducts(const float* a, const float* b, int n, float* squares, float* products) {
  HWY_DYNAMIC_DISPATCH(SsimProducts)(a, b, n, squares, products);
}
void SsimOfMoments(const float* const moments[4], int n, float* ssim, float* const by_moments[3]) {
  HWY_DYNAMIC_DISPATCH(SsimOfMoments)(moments, n, ssim, by_moments);
}

}  // namespace bodyloom::avatar_internal
#endif  // HWY_ONCE
