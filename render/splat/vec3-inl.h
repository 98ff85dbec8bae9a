// SPDX-License-Identifier: Apache-2.0
/// Registers of three-vectors, products and sums never fused. For *_simd.cc files only: included once per instruction
/// set, after <hwy/highway.h>.
#if defined(BODYLOOM_RENDER_SPLAT_VEC3_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BODYLOOM_RENDER_SPLAT_VEC3_INL_H_
#undef BODYLOOM_RENDER_SPLAT_VEC3_INL_H_
#else
#define BODYLOOM_RENDER_SPLAT_VEC3_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace bodyloom::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Vec3 {
  V x, y, z;
};
template <class V>
HWY_INLINE Vec3<V> operator+(Vec3<V> a, Vec3<V> b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
template <class V>
HWY_INLINE Vec3<V> operator-(Vec3<V> a, Vec3<V> b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class V>
HWY_INLINE Vec3<V> operator*(V s, Vec3<V> a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}
template <class V>
HWY_INLINE V Dot(Vec3<V> a, Vec3<V> b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
template <class V>
HWY_INLINE Vec3<V> Cross(Vec3<V> a, Vec3<V> b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

/// Three rows.
template <class V>
struct Mat3 {
  Vec3<V> r0, r1, r2;
};
template <class V>
HWY_INLINE Vec3<V> operator*(const Mat3<V>& m, Vec3<V> a) {
  return {Dot(m.r0, a), Dot(m.r1, a), Dot(m.r2, a)};
}
template <class V>
HWY_INLINE Mat3<V> Transposed(const Mat3<V>& m) {
  return {{m.r0.x, m.r1.x, m.r2.x}, {m.r0.y, m.r1.y, m.r2.y}, {m.r0.z, m.r1.z, m.r2.z}};
}
/// a bᵀ.
template <class V>
HWY_INLINE Mat3<V> TimesTransposed(const Mat3<V>& a, const Mat3<V>& b) {
  return {b * a.r0, b * a.r1, b * a.r2};
}
template <class V>
HWY_INLINE Mat3<V> operator+(const Mat3<V>& a, const Mat3<V>& b) {
  return {a.r0 + b.r0, a.r1 + b.r1, a.r2 + b.r2};
}
/// The outer product a bᵀ.
template <class V>
HWY_INLINE Mat3<V> Outer(Vec3<V> a, Vec3<V> b) {
  return {a.x * b, a.y * b, a.z * b};
}

}  // namespace bodyloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
