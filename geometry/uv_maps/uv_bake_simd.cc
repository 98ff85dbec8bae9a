// SPDX-License-Identifier: Apache-2.0
#include "geometry/uv_maps/uv_bake_simd.h"

#include <cmath>
#include <cstring>

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "geometry/uv_maps/uv_bake_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#include "geometry/math/quad-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bodyloom::uv_bake_internal::HWY_NAMESPACE {

using namespace bodyloom::HWY_NAMESPACE;  // Quad

constexpr float kShortestSquared = 1e-12F;

HWY_INLINE Quad Texel(const Block& block, int i, const float* HWY_RESTRICT attributes) {
  const int32_t* vertex = block.vertex[i];
  const float* weight = block.weight[i];
  const Quad ab = MulAdd(Fill(weight[1]), LoadQuadU(attributes + 4 * int64_t{vertex[1]}),
                         Fill(weight[0]) * LoadQuadU(attributes + 4 * int64_t{vertex[0]}));
  return MulAdd(Fill(weight[2]), LoadQuadU(attributes + 4 * int64_t{vertex[2]}), ab);
}

HWY_INLINE void StoreUpTo(Quad values, int count, float* HWY_RESTRICT out) {
  if (count >= 4) {
    StoreQuadU(values, out);
    return;
  }
  HWY_ALIGN float lanes[4];
  StoreQuad(values, lanes);
  for (int i = 0; i < count; ++i) out[i] = lanes[i];
}

void BakeGroup(const Block* HWY_RESTRICT blocks, int num_blocks, int num_pixels, const float* HWY_RESTRICT attributes,
               int num_planes, float* const* planes) {
  for (int n = 0; n < num_blocks; ++n) {
    const Block& block = blocks[n];
    Quad c[4] = {Texel(block, 0, attributes), Texel(block, 1, attributes), Texel(block, 2, attributes),
                 Texel(block, 3, attributes)};
    Transpose(c[0], c[1], c[2], c[3]);
    const int count = num_pixels - block.pixel;
    for (int p = 0; p < num_planes; ++p) StoreUpTo(c[p], count, planes[p] + block.pixel);
  }
}

void BakeTwoGroups(const Block* HWY_RESTRICT blocks, int num_blocks, int num_pixels,
                   const float* HWY_RESTRICT attributes, int64_t group_stride, float* const* planes) {
  const float* HWY_RESTRICT others = attributes + group_stride;
  for (int n = 0; n < num_blocks; ++n) {
    const Block& block = blocks[n];
    Quad c[8];
    for (int i = 0; i < 4; ++i) {
      const int64_t v0 = 4 * int64_t{block.vertex[i][0]}, v1 = 4 * int64_t{block.vertex[i][1]},
                    v2 = 4 * int64_t{block.vertex[i][2]};
      const Quad w0 = Fill(block.weight[i][0]), w1 = Fill(block.weight[i][1]), w2 = Fill(block.weight[i][2]);
      c[i] = MulAdd(w2, LoadQuadU(attributes + v2),
                    MulAdd(w1, LoadQuadU(attributes + v1), w0 * LoadQuadU(attributes + v0)));
      c[4 + i] = MulAdd(w2, LoadQuadU(others + v2), MulAdd(w1, LoadQuadU(others + v1), w0 * LoadQuadU(others + v0)));
    }
    Transpose(c[0], c[1], c[2], c[3]);
    Transpose(c[4], c[5], c[6], c[7]);
    const int count = num_pixels - block.pixel;
    for (int p = 0; p < 8; ++p) StoreUpTo(c[p], count, planes[p] + block.pixel);
  }
}

int BakeUnitVectors(const Block* HWY_RESTRICT blocks, int num_blocks, int num_pixels,
                    const float* HWY_RESTRICT attributes, float* const* planes) {
  const Quad zero = Fill(0), one = Fill(1), shortest = Fill(kShortestSquared);
  int num_zero = 0;
  for (int n = 0; n < num_blocks; ++n) {
    const Block& block = blocks[n];
    Quad x = Texel(block, 0, attributes), y = Texel(block, 1, attributes), z = Texel(block, 2, attributes),
         w = Texel(block, 3, attributes);
    Transpose(x, y, z, w);
    const Quad length2 = MulAdd(x, x, MulAdd(y, y, z * z));
    const Quad factor = IfGreater(length2, shortest, one / Sqrt(Max(length2, shortest)), zero);
    const int count = num_pixels - block.pixel;
    StoreUpTo(x * factor, count, planes[0] + block.pixel);
    StoreUpTo(y * factor, count, planes[1] + block.pixel);
    StoreUpTo(z * factor, count, planes[2] + block.pixel);
    if (!AllGreater(factor, zero)) {
      HWY_ALIGN float lanes[4];
      StoreQuad(factor, lanes);
      for (int i = 0; i < 4 && i < count; ++i) num_zero += lanes[i] == 0;
    }
  }
  return num_zero;
}

#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128 || HWY_TARGET == HWY_SSE4
// No instruction for it, and Highway 1.0.3 cuts off where it should round.
void HalfFromFloat(const float* HWY_RESTRICT values, int64_t count, uint16_t* HWY_RESTRICT halves) {
  for (int64_t i = 0; i < count; ++i) {
    uint32_t bits = 0;
    std::memcpy(&bits, values + i, sizeof bits);
    const uint32_t sign = bits >> 16 & 0x8000;
    bits &= 0x7fffffff;
    uint32_t half = 0;
    if (bits >= 0x47800000) {  // 65536 and more, infinity, NaN
      half = bits > 0x7f800000 ? 0x7e00 : 0x7c00;
    } else if (bits < 0x38800000) {  // denormal: adding 1/2 leaves the rounded mantissa in the last ten bits
      float shifted = 0;
      std::memcpy(&shifted, &bits, sizeof shifted);
      shifted += 0.5F;
      std::memcpy(&half, &shifted, sizeof half);
      half -= 0x3f000000;
    } else {
      half = (bits - 0x38000000 + 0xfff + (bits >> 13 & 1)) >> 13;
    }
    halves[i] = static_cast<uint16_t>(sign | half);
  }
}
#else
void HalfFromFloat(const float* HWY_RESTRICT values, int64_t count, uint16_t* HWY_RESTRICT halves) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<float, 16> d;
  const hn::Rebind<hwy::float16_t, decltype(d)> half;
  const hn::Rebind<uint16_t, decltype(d)> bits;
  const int64_t N = static_cast<int64_t>(hn::Lanes(d));
  HWY_ALIGN float last[16] = {};
  for (int64_t i = 0; i < count; i += N) {
    const int64_t here = count - i < N ? count - i : N;
    if (here < N) std::memcpy(last, values + i, here * sizeof(float));
    const auto converted = hn::BitCast(bits, hn::DemoteTo(half, hn::LoadU(d, here < N ? last : values + i)));
    if (here == N) {
      hn::StoreU(converted, bits, halves + i);
    } else {
      HWY_ALIGN uint16_t out[16];
      hn::StoreU(converted, bits, out);
      std::memcpy(halves + i, out, here * sizeof(uint16_t));
    }
  }
}
#endif

}  // namespace bodyloom::uv_bake_internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bodyloom::uv_bake_internal {

HWY_EXPORT(BakeGroup);
HWY_EXPORT(BakeTwoGroups);
HWY_EXPORT(BakeUnitVectors);
HWY_EXPORT(HalfFromFloat);

void BakeGroup(const Block* blocks, int num_blocks, int num_pixels, const float* attributes, int num_planes,
               float* const* planes) {
  HWY_DYNAMIC_DISPATCH(BakeGroup)(blocks, num_blocks, num_pixels, attributes, num_planes, planes);
}

void BakeTwoGroups(const Block* blocks, int num_blocks, int num_pixels, const float* attributes, int64_t group_stride,
                   float* const* planes) {
  HWY_DYNAMIC_DISPATCH(BakeTwoGroups)(blocks, num_blocks, num_pixels, attributes, group_stride, planes);
}

int BakeUnitVectors(const Block* blocks, int num_blocks, int num_pixels, const float* attributes,
                    float* const* planes) {
  return HWY_DYNAMIC_DISPATCH(BakeUnitVectors)(blocks, num_blocks, num_pixels, attributes, planes);
}

void HalfFromFloat(const float* values, int64_t count, uint16_t* halves) {
  HWY_DYNAMIC_DISPATCH(HalfFromFloat)(values, count, halves);
}

}  // namespace bodyloom::uv_bake_internal
#endif  // HWY_ONCE
