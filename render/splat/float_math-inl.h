// SPDX-License-Identifier: Apache-2.0
/// 2^x, e^x and log2 of floats, the same bits on every instruction set: polynomials of plain products and sums, never
/// fused. For *_simd.cc files only: included once per instruction set, after <hwy/highway.h>.
#if defined(BODYLOOM_RENDER_SPLAT_FLOAT_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BODYLOOM_RENDER_SPLAT_FLOAT_MATH_INL_H_
#undef BODYLOOM_RENDER_SPLAT_FLOAT_MATH_INL_H_
#else
#define BODYLOOM_RENDER_SPLAT_FLOAT_MATH_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace bodyloom::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// 2^f · 2^n for f in [−½, ½] and the integer n = `shifted` − 1.5·2²³; relative error 2e-7.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V PowerOfTwo(D d, V f, V shifted) {
  const hn::Rebind<int32_t, D> di;
  // Minimax in the relative error (7.5e-8 before rounding).
  V p = hn::Set(d, 0.0013276472F);
  p = hn::Add(hn::Mul(p, f), hn::Set(d, 0.009675542F));
  p = hn::Add(hn::Mul(p, f), hn::Set(d, 0.05550713F));
  p = hn::Add(hn::Mul(p, f), hn::Set(d, 0.2402212F));
  p = hn::Add(hn::Mul(p, f), hn::Set(d, 0.69314694F));
  p = hn::Add(hn::Mul(p, f), hn::Set(d, 1.0000001F));
  return hn::BitCast(d, hn::Add(hn::BitCast(di, p), hn::ShiftLeft<23>(hn::BitCast(di, shifted))));
}

/// 2^t for −120 < t < 120; undefined bits elsewhere.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Exp2(D d, V t) {
  const V magic = hn::Set(d, 12582912.0F);  // rounds to an integer, held in the lowest bits
  const V shifted = hn::Add(t, magic);
  return PowerOfTwo(d, hn::Sub(t, hn::Sub(shifted, magic)), shifted);
}

/// e^x, relative error 3e-7; x is clamped to [−80, 80] first, NaN stays NaN.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Exp(D d, V x) {
  x = hn::IfThenElse(hn::Lt(x, hn::Set(d, -80.0F)), hn::Set(d, -80.0F), x);
  x = hn::IfThenElse(hn::Gt(x, hn::Set(d, 80.0F)), hn::Set(d, 80.0F), x);
  const V magic = hn::Set(d, 12582912.0F);
  const V shifted = hn::Add(hn::Mul(x, hn::Set(d, 1.44269504F)), magic);
  const V n = hn::Sub(shifted, magic);
  // ln 2 in two parts: n times the first is exact.
  V rest = hn::Sub(x, hn::Mul(n, hn::Set(d, 0.693359375F)));
  rest = hn::Sub(rest, hn::Mul(n, hn::Set(d, -2.12194440e-4F)));
  return hn::Add(PowerOfTwo(d, hn::Mul(rest, hn::Set(d, 1.44269504F)), shifted), hn::Sub(x, x));
}

/// log2 of a normal positive float, error 2e-7, absolute near 1 and relative elsewhere; undefined bits otherwise.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Log2(D d, V x) {
  const hn::Rebind<int32_t, D> di;
  // x = 2^n m with m in [√½, √2): subtracting the bits of √½ makes the exponent field n.
  const auto offset = hn::Sub(hn::BitCast(di, x), hn::Set(di, 0x3f3504f3));
  const V n = hn::ConvertTo(d, hn::ShiftRight<23>(offset));
  const auto mantissa = hn::Add(hn::And(offset, hn::Set(di, 0x007fffff)), hn::Set(di, 0x3f3504f3));
  const V m = hn::BitCast(d, mantissa), one = hn::Set(d, 1.0F);
  // ln m = 2 artanh s of s = (m − 1)/(m + 1), |s| ≤ 0.172: its power series.
  const V s = hn::Div(hn::Sub(m, one), hn::Add(m, one)), s2 = hn::Mul(s, s);
  V p = hn::Set(d, 1.0F / 9);
  p = hn::Add(hn::Mul(p, s2), hn::Set(d, 1.0F / 7));
  p = hn::Add(hn::Mul(p, s2), hn::Set(d, 1.0F / 5));
  p = hn::Add(hn::Mul(p, s2), hn::Set(d, 1.0F / 3));
  p = hn::Add(hn::Mul(p, s2), one);
  return hn::Add(n, hn::Mul(hn::Mul(s, hn::Set(d, 2.88539008F)), p));
}

}  // namespace bodyloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
