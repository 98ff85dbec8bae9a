// SPDX-License-Identifier: Apache-2.0
#include "render/view/shade_simd.h"

#include <algorithm>

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/view/shade_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bodyloom::shade_internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::CappedTag<float, kLanes>;
using VF = hn::Vec<DF>;

void FindContour(const ContourRow& row, float step_m, bool linear, int8_t* mask) {
  const DF d;
  const hn::Rebind<int32_t, DF> di;
  const hn::Rebind<int8_t, DF> db;
  const int N = static_cast<int>(hn::Lanes(d));
  const auto find = [&](const float* here, const float* const* neighbours, int8_t* to) HWY_ATTR {
    const VF at = hn::LoadU(d, here), step = hn::Set(d, step_m);
    const VF limit = linear ? hn::Sub(at, step) : hn::Div(at, hn::Add(hn::Set(d, 1.0F), hn::Mul(step, at)));
    VF minimum = hn::LoadU(d, neighbours[0]);
    for (int k = 1; k < 8; ++k) minimum = hn::Min(minimum, hn::LoadU(d, neighbours[k]));
    hn::StoreU(hn::DemoteTo(db, hn::VecFromMask(di, hn::RebindMask(di, hn::Lt(minimum, limit)))), db, to);
  };
  int i = 0;
  for (; i + N <= row.count; i += N) {
    const float* neighbours[8];
    for (int k = 0; k < 8; ++k) neighbours[k] = row.neighbours[k] + i;
    find(row.here + i, neighbours, mask + i);
  }
  if (i == row.count) return;
  float padded[9][kLanes] = {};
  int8_t bytes[kLanes];
  const float* neighbours[8];
  std::copy(row.here + i, row.here + row.count, padded[8]);
  for (int k = 0; k < 8; ++k) {
    std::copy(row.neighbours[k] + i, row.neighbours[k] + row.count, padded[k]);
    neighbours[k] = padded[k];
  }
  find(padded[8], neighbours, bytes);
  std::copy(bytes, bytes + (row.count - i), mask + i);
}

void ShadePixels(const ShadedRow& row) {
  const DF d;
  const int N = static_cast<int>(hn::Lanes(d));
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0F), half = hn::Set(d, 0.5F);
  const auto dot = [&](VF x, VF y, VF z, const float(&v)[3]) HWY_ATTR {
    return hn::Add(hn::Add(hn::Mul(x, hn::Set(d, v[0])), hn::Mul(y, hn::Set(d, v[1]))), hn::Mul(z, hn::Set(d, v[2])));
  };
  // Unit directions, camera frame (the viewer looks along +z): key light from the upper left behind the viewer, fill
  // light from the right, and the half vector of the key light.
  static constexpr float kKey[3] = {-0.447900F, -0.646966F, -0.617106F};
  static constexpr float kFill[3] = {0.754732F, -0.050315F, -0.654101F};
  static constexpr float kHalfway[3] = {-0.249056F, -0.359747F, -0.899196F};
  for (int i = 0; i < row.count; i += N) {
    VF x = hn::LoadU(d, row.nx + i), y = hn::LoadU(d, row.ny + i), z = hn::LoadU(d, row.nz + i);
    const VF square = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
    const VF scale = hn::IfThenElse(hn::Gt(square, zero), hn::Div(one, hn::Sqrt(square)), zero);
    x = hn::Mul(x, scale), y = hn::Mul(y, scale), z = hn::Mul(z, scale);
    const VF key = hn::Max(zero, hn::Add(half, hn::Mul(half, dot(x, y, z, kKey))));  // wrapped: no hard terminator
    const VF fill = hn::Max(zero, dot(x, y, z, kFill));
    const VF sky = hn::Sub(half, hn::Mul(half, y));
    const VF edge = hn::Sub(one, hn::Min(one, hn::Abs(z)));
    const VF rim = hn::Mul(edge, hn::Mul(edge, edge));
    VF spark = hn::Max(zero, dot(x, y, z, kHalfway));
    for (int k = 0; k < 5; ++k) spark = hn::Mul(spark, spark);  // to the power of 32
    const VF diffuse = hn::Add(hn::Add(hn::Set(d, 0.22F), hn::Mul(hn::Set(d, 0.72F), hn::Mul(key, key))),
                               hn::Add(hn::Mul(hn::Set(d, 0.13F), fill), hn::Mul(hn::Set(d, 0.12F), sky)));
    const VF highlight = hn::Mul(
        hn::Set(d, 255.0F), hn::Add(hn::Mul(hn::Set(d, 0.10F), spark), hn::Mul(hn::Set(d, 0.16F), hn::Mul(rim, sky))));
    for (float* colour : {row.blue + i, row.green + i, row.red + i}) {
      const VF lit = hn::Add(hn::Mul(hn::LoadU(d, colour), diffuse), highlight);
      hn::StoreU(hn::Min(lit, hn::Set(d, 255.0F)), d, colour);
    }
  }
}

void BlendPixels(const BlendedRow& row, uint8_t* bgr) {
  const DF d;
  const hn::Rebind<int32_t, DF> di;
  const hn::Rebind<uint8_t, DF> db;
  const int N = static_cast<int>(hn::Lanes(d));
  const auto blend = [&](int i, uint8_t* p) HWY_ATTR {
    hn::Vec<decltype(db)> channel[3];
    hn::LoadInterleaved3(db, p, channel[0], channel[1], channel[2]);
    const VF keep = hn::Sub(hn::Set(d, 1.0F), hn::LoadU(d, row.cover + i));
    const float* colours[3] = {row.blue + i, row.green + i, row.red + i};
    for (int c = 0; c < 3; ++c) {
      const VF before = hn::ConvertTo(d, hn::PromoteTo(di, channel[c]));
      const VF after = hn::Add(hn::Add(hn::Mul(before, keep), hn::LoadU(d, colours[c])), hn::Set(d, 0.5F));
      channel[c] = hn::DemoteTo(db, hn::ConvertTo(di, after));
    }
    hn::StoreInterleaved3(channel[0], channel[1], channel[2], db, p);
  };
  int i = 0;
  for (; i + N <= row.count; i += N) blend(i, bgr + 3 * i);
  if (i == row.count) return;
  uint8_t padded[3 * kLanes] = {};
  std::copy(bgr + 3 * i, bgr + 3 * row.count, padded);
  blend(i, padded);
  std::copy(padded, padded + 3 * (row.count - i), bgr + 3 * i);
}

}  // namespace bodyloom::shade_internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bodyloom::shade_internal {

HWY_EXPORT(FindContour);
HWY_EXPORT(ShadePixels);
HWY_EXPORT(BlendPixels);

void FindContour(const ContourRow& row, float step_m, bool linear, int8_t* mask) {
  HWY_DYNAMIC_DISPATCH(FindContour)(row, step_m, linear, mask);
}

void ShadePixels(const ShadedRow& row) { HWY_DYNAMIC_DISPATCH(ShadePixels)(row); }

void BlendPixels(const BlendedRow& row, uint8_t* bgr) { HWY_DYNAMIC_DISPATCH(BlendPixels)(row, bgr); }

}  // namespace bodyloom::shade_internal
#endif  // HWY_ONCE
