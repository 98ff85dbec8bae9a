// SPDX-License-Identifier: Apache-2.0
/// Four floats in a register on every instruction set, including the scalar one, where Highway's vectors have one lane.
/// For *_simd.cc files only: included once per instruction set, after <hwy/highway.h>.
#if defined(BODYLOOM_GEOMETRY_QUAD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BODYLOOM_GEOMETRY_QUAD_INL_H_
#undef BODYLOOM_GEOMETRY_QUAD_INL_H_
#else
#define BODYLOOM_GEOMETRY_QUAD_INL_H_
#endif

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace bodyloom::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

struct Quad {
  float lane[4];
};
template <typename F>
HWY_INLINE Quad ByLane(F f) {
  return {{f(0), f(1), f(2), f(3)}};
}
HWY_INLINE Quad Fill(float x) { return {{x, x, x, x}}; }
HWY_INLINE Quad LoadQuad(const float* p) { return {{p[0], p[1], p[2], p[3]}}; }
HWY_INLINE Quad LoadQuadU(const float* p) { return LoadQuad(p); }
HWY_INLINE void StoreQuad(const Quad& a, float* p) {
  for (int i = 0; i < 4; ++i) p[i] = a.lane[i];
}
HWY_INLINE void StoreQuadU(const Quad& a, float* p) { StoreQuad(a, p); }
HWY_INLINE Quad operator+(Quad a, Quad b) {
  return ByLane([&](int i) { return a.lane[i] + b.lane[i]; });
}
HWY_INLINE Quad operator-(Quad a, Quad b) {
  return ByLane([&](int i) { return a.lane[i] - b.lane[i]; });
}
HWY_INLINE Quad operator*(Quad a, Quad b) {
  return ByLane([&](int i) { return a.lane[i] * b.lane[i]; });
}
HWY_INLINE Quad operator/(Quad a, Quad b) {
  return ByLane([&](int i) { return a.lane[i] / b.lane[i]; });
}
HWY_INLINE Quad MulAdd(Quad a, Quad b, Quad c) { return a * b + c; }
HWY_INLINE Quad NegMulAdd(Quad a, Quad b, Quad c) { return c - a * b; }
HWY_INLINE Quad Abs(Quad a) {
  return ByLane([&](int i) { return std::fabs(a.lane[i]); });
}
HWY_INLINE Quad Sqrt(Quad a) {
  return ByLane([&](int i) { return std::sqrt(a.lane[i]); });
}
HWY_INLINE Quad Max(Quad a, Quad b) {
  return ByLane([&](int i) { return a.lane[i] > b.lane[i] ? a.lane[i] : b.lane[i]; });
}
HWY_INLINE Quad Min(Quad a, Quad b) {
  return ByLane([&](int i) { return a.lane[i] < b.lane[i] ? a.lane[i] : b.lane[i]; });
}
/// a where x > y, b elsewhere.
HWY_INLINE Quad IfGreater(Quad x, Quad y, Quad a, Quad b) {
  return ByLane([&](int i) { return x.lane[i] > y.lane[i] ? a.lane[i] : b.lane[i]; });
}
HWY_INLINE bool AllGreater(Quad x, Quad y) {
  return x.lane[0] > y.lane[0] && x.lane[1] > y.lane[1] && x.lane[2] > y.lane[2] && x.lane[3] > y.lane[3];
}
/// The fourth lane set to zero.
HWY_INLINE Quad FirstThree(Quad a) { return {{a.lane[0], a.lane[1], a.lane[2], 0}}; }
/// Four rows to four columns.
HWY_INLINE void Transpose(Quad& a, Quad& b, Quad& c, Quad& d) {
  const Quad rows[4] = {a, b, c, d};
  Quad* columns[4] = {&a, &b, &c, &d};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) columns[i]->lane[j] = rows[j].lane[i];
  }
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using QuadTag = hn::CappedTag<float, 4>;

struct Quad {
  hn::Vec<QuadTag> v;
};
HWY_INLINE Quad Fill(float x) { return {hn::Set(QuadTag(), x)}; }
HWY_INLINE Quad LoadQuad(const float* p) { return {hn::Load(QuadTag(), p)}; }
HWY_INLINE Quad LoadQuadU(const float* p) { return {hn::LoadU(QuadTag(), p)}; }
HWY_INLINE void StoreQuad(Quad a, float* p) { hn::Store(a.v, QuadTag(), p); }
HWY_INLINE void StoreQuadU(Quad a, float* p) { hn::StoreU(a.v, QuadTag(), p); }
HWY_INLINE Quad operator+(Quad a, Quad b) { return {hn::Add(a.v, b.v)}; }
HWY_INLINE Quad operator-(Quad a, Quad b) { return {hn::Sub(a.v, b.v)}; }
HWY_INLINE Quad operator*(Quad a, Quad b) { return {hn::Mul(a.v, b.v)}; }
HWY_INLINE Quad operator/(Quad a, Quad b) { return {hn::Div(a.v, b.v)}; }
HWY_INLINE Quad MulAdd(Quad a, Quad b, Quad c) { return {hn::MulAdd(a.v, b.v, c.v)}; }
HWY_INLINE Quad NegMulAdd(Quad a, Quad b, Quad c) { return {hn::NegMulAdd(a.v, b.v, c.v)}; }
HWY_INLINE Quad Abs(Quad a) { return {hn::Abs(a.v)}; }
HWY_INLINE Quad Sqrt(Quad a) { return {hn::Sqrt(a.v)}; }
HWY_INLINE Quad Max(Quad a, Quad b) { return {hn::Max(a.v, b.v)}; }
HWY_INLINE Quad Min(Quad a, Quad b) { return {hn::Min(a.v, b.v)}; }
HWY_INLINE Quad IfGreater(Quad x, Quad y, Quad a, Quad b) { return {hn::IfThenElse(hn::Gt(x.v, y.v), a.v, b.v)}; }
HWY_INLINE bool AllGreater(Quad x, Quad y) { return hn::AllTrue(QuadTag(), hn::Gt(x.v, y.v)); }
HWY_INLINE Quad FirstThree(Quad a) { return {hn::IfThenElseZero(hn::FirstN(QuadTag(), 3), a.v)}; }
HWY_INLINE void Transpose(Quad& a, Quad& b, Quad& c, Quad& d) {
  const QuadTag t;
  const auto ac_low = hn::InterleaveLower(t, a.v, c.v), ac_high = hn::InterleaveUpper(t, a.v, c.v);
  const auto bd_low = hn::InterleaveLower(t, b.v, d.v), bd_high = hn::InterleaveUpper(t, b.v, d.v);
  a.v = hn::InterleaveLower(t, ac_low, bd_low);
  b.v = hn::InterleaveUpper(t, ac_low, bd_low);
  c.v = hn::InterleaveLower(t, ac_high, bd_high);
  d.v = hn::InterleaveUpper(t, ac_high, bd_high);
}

#endif

}  // namespace bodyloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
