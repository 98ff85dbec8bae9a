// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/skinning_simd.h"

#include <atomic>

// Instruction sets that add nothing to this loop, and those whose vectors have no size at compile time.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "geometry/body/skinning_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bodyloom::skinning_internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kTileVertices = 16;
constexpr int kTileValues = 3 * kTileVertices;

/// One value of neighbouring frames, in one register or in two. Plain members rather than arrays: compilers keep those
/// in registers.
template <class D>
struct Single {
  hn::Vec<D> a;
  static Single Fill(D d, float x) { return {hn::Set(d, x)}; }
  static Single Load(D d, const float* HWY_RESTRICT p) { return {hn::Load(d, p)}; }
  void Store(D d, float* HWY_RESTRICT p) const { hn::Store(a, d, p); }
  Single operator+(Single other) const { return {hn::Add(a, other.a)}; }
  Single Times(Single other, Single plus) const { return {hn::MulAdd(a, other.a, plus.a)}; }
};

template <class D>
struct Double {
  hn::Vec<D> a, b;
  static Double Fill(D d, float x) { return {hn::Set(d, x), hn::Set(d, x)}; }
  static Double Load(D d, const float* HWY_RESTRICT p) { return {hn::Load(d, p), hn::Load(d, p + hn::Lanes(d))}; }
  void Store(D d, float* HWY_RESTRICT p) const {
    hn::Store(a, d, p);
    hn::Store(b, d, p + hn::Lanes(d));
  }
  Double operator+(Double other) const { return {hn::Add(a, other.a), hn::Add(b, other.b)}; }
  Double Times(Double other, Double plus) const {
    return {hn::MulAdd(a, other.a, plus.a), hn::MulAdd(b, other.b, plus.b)};
  }
};

template <class Lanes>
struct Point {
  Lanes x, y, z;
};

/// Adds column `e` of a 3×9 block times feature e.
template <int e, class Lanes, class D>
HWY_INLINE void AddFeature(D d, const float* HWY_RESTRICT block, const float* HWY_RESTRICT features,
                           Point<Lanes>& sum) {
  const Lanes feature = Lanes::Load(d, features + e * kFrameLanes);
  std::atomic_signal_fence(std::memory_order_acq_rel);  // keeps g++ from loading it again for each of its three uses
  sum.x = Lanes::Fill(d, block[e]).Times(feature, sum.x);
  sum.y = Lanes::Fill(d, block[9 + e]).Times(feature, sum.y);
  sum.z = Lanes::Fill(d, block[18 + e]).Times(feature, sum.z);
}

/// Row · (point, 1), the row's four entries kFrameLanes apart.
template <class Lanes, class D>
HWY_INLINE Lanes Transform(D d, const float* HWY_RESTRICT row, const Point<Lanes>& point) {
  Lanes sum = Lanes::Load(d, row).Times(point.x, Lanes::Load(d, row + 3 * kFrameLanes));
  sum = Lanes::Load(d, row + kFrameLanes).Times(point.y, sum);
  return Lanes::Load(d, row + 2 * kFrameLanes).Times(point.z, sum);
}

/// One vertex in the frames from `lane` on; tile holds x, y, z of kFrameLanes frames each.
template <class Lanes, class D>
HWY_INLINE void SkinVertex(D d, const Body& body, const Frames& frames, int i, int lane, float* HWY_RESTRICT tile) {
  const int v = body.vertices[i];
  const Lanes zero = Lanes::Fill(d, 0);

  // Correctives. Even and odd features go to separate sums: twice as many multiply-adds in flight.
  Point<Lanes> even{zero, zero, zero}, odd{zero, zero, zero};
  if (body.corrective_begin != nullptr) {
    for (int k = body.corrective_begin[v]; k < body.corrective_begin[v + 1]; ++k) {
      const int joint = body.corrective_joint[k];
      if (frames.feature_is_zero[joint]) continue;
      const float* HWY_RESTRICT block = body.corrective_block + 27 * static_cast<int64_t>(k);
      const float* HWY_RESTRICT features = frames.features + 9 * joint * kFrameLanes + lane;
      AddFeature<0>(d, block, features, even);
      AddFeature<1>(d, block, features, odd);
      AddFeature<2>(d, block, features, even);
      AddFeature<3>(d, block, features, odd);
      AddFeature<4>(d, block, features, even);
      AddFeature<5>(d, block, features, odd);
      AddFeature<6>(d, block, features, even);
      AddFeature<7>(d, block, features, odd);
      AddFeature<8>(d, block, features, even);
    }
  }
  const float* HWY_RESTRICT shaped = body.rest + 3 * static_cast<int64_t>(i);
  const Point<Lanes> rest{Lanes::Fill(d, shaped[0]) + (even.x + odd.x), Lanes::Fill(d, shaped[1]) + (even.y + odd.y),
                          Lanes::Fill(d, shaped[2]) + (even.z + odd.z)};

  Point<Lanes> posed{zero, zero, zero};
  for (int k = body.influence_begin[v]; k < body.influence_begin[v + 1]; ++k) {
    const Lanes weight = Lanes::Fill(d, body.influence_weight[k]);
    const float* HWY_RESTRICT bone = frames.bones + 12 * body.influence_joint[k] * kFrameLanes + lane;
    posed.x = weight.Times(Transform(d, bone, rest), posed.x);
    posed.y = weight.Times(Transform(d, bone + 4 * kFrameLanes, rest), posed.y);
    posed.z = weight.Times(Transform(d, bone + 8 * kFrameLanes, rest), posed.z);
  }
  posed.x.Store(d, tile + lane);
  posed.y.Store(d, tile + kFrameLanes + lane);
  posed.z.Store(d, tile + 2 * kFrameLanes + lane);
}

/// Frames outermost to vertices outermost: tile [value][frame] to output [frame][value].
void StoreTile(const Frames& frames, const float* HWY_RESTRICT tile, int first, int count) {
  for (int f = 0; f < frames.num_frames; ++f) {
    const int64_t offset = f * frames.output_stride + 3 * static_cast<int64_t>(first);
    if (frames.float_output != nullptr) {
      float* HWY_RESTRICT out = frames.float_output + offset;
      for (int i = 0; i < 3 * count; ++i) out[i] = tile[i * kFrameLanes + f];
    } else {
      double* HWY_RESTRICT out = frames.double_output + offset;
      const double* root = frames.roots + 3 * f;
      for (int i = 0; i < 3 * count; i += 3) {
        for (int c = 0; c < 3; ++c) out[i + c] = root[c] + double{tile[(i + c) * kFrameLanes + f]};
      }
    }
  }
}

void SkinVertices(const Body& body, const Frames& frames, int first, int last) {
  using Wide = hn::CappedTag<float, 16>;   // 16 lanes with AVX-512, 8 with AVX2, 4 elsewhere
  using Narrow = hn::CappedTag<float, 4>;  // for the last few frames
  const Wide wide;
  const Narrow narrow;
  const int N = static_cast<int>(hn::Lanes(wide)), n = static_cast<int>(hn::Lanes(narrow));
  HWY_ALIGN float tile[kTileValues * kFrameLanes];
  for (int tile_first = first; tile_first < last; tile_first += kTileVertices) {
    const int count = last - tile_first < kTileVertices ? last - tile_first : kTileVertices;
    for (int i = 0; i < count; ++i) {
      float* values = tile + 3 * i * kFrameLanes;
      for (int lane = 0; lane < frames.num_frames;) {
        const int remaining = frames.num_frames - lane;
        if (remaining > N) {
          SkinVertex<Double<Wide>>(wide, body, frames, tile_first + i, lane, values);
          lane += 2 * N;
        } else if (remaining > n) {
          SkinVertex<Single<Wide>>(wide, body, frames, tile_first + i, lane, values);
          lane += N;
        } else {
          SkinVertex<Single<Narrow>>(narrow, body, frames, tile_first + i, lane, values);
          lane += n;
        }
      }
    }
    StoreTile(frames, tile, tile_first, count);
  }
}

int64_t CompiledFor() { return HWY_TARGET; }

}  // namespace bodyloom::skinning_internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bodyloom::skinning_internal {

HWY_EXPORT(SkinVertices);
HWY_EXPORT(CompiledFor);

void SkinVertices(const Body& body, const Frames& frames, int first, int last) {
  HWY_DYNAMIC_DISPATCH(SkinVertices)(body, frames, first, last);
}

std::vector<int64_t> SimdTargets() { return hwy::SupportedAndGeneratedTargets(); }

std::string SimdTargetName(int64_t target) { return hwy::TargetName(target); }

std::string ChosenSimdTarget() { return hwy::TargetName(HWY_DYNAMIC_DISPATCH(CompiledFor)()); }

void ForceSimdTarget(int64_t target) { hwy::SetSupportedTargetsForTest(target); }

}  // namespace bodyloom::skinning_internal
#endif  // HWY_ONCE
