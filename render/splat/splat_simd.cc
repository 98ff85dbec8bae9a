// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/splat/splat_simd.h"

#include <algorithm>
#include <bit>

#include "bodyloom/render/splat/screen_gaussians.h"

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bodyloom/render/splat/splat_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#include "bodyloom/geometry/quad-inl.h"
#include "bodyloom/render/splat/float_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bodyloom::splat_internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using bodyloom::HWY_NAMESPACE::Exp2;
using bodyloom::HWY_NAMESPACE::LoadQuad;
using bodyloom::HWY_NAMESPACE::Quad;
using bodyloom::HWY_NAMESPACE::StoreQuad;
using bodyloom::HWY_NAMESPACE::Transpose;

using DF = hn::CappedTag<float, kTileSize>;
using VF = hn::Vec<DF>;
using MF = hn::Mask<DF>;

constexpr int kN = static_cast<int>(hn::MaxLanes(DF()));
constexpr int kParts = kTileSize / kN;  ///< vectors a row of a tile
constexpr int kEntriesBetweenLooks = 8;

/// The rows of the tile that a Gaussian may reach, and the exponent's constants there.
struct Rows {
  uint32_t mask;
  alignas(64) float base[kTileSize];   ///< log2 o + c d_y²
  alignas(64) float slope[kTileSize];  ///< b d_y
};

HWY_INLINE void FindRows(const SplatShape& g, float left, float top, uint32_t alive, Rows* rows) {
  const DF d;
  const VF a = hn::Set(d, g.a), first = hn::Set(d, left - g.x), last = hn::Set(d, left - g.x + (kTileSize - 1));
  uint32_t mask = 0;
  for (int part = 0; part < kParts; ++part) {
    const VF dy = hn::Sub(hn::Iota(d, top + static_cast<float>(part * kN)), hn::Set(d, g.y));
    const VF base = hn::Add(hn::Set(d, g.log2_opacity), hn::Mul(hn::Set(d, g.c), hn::Mul(dy, dy)));
    const VF slope = hn::Mul(hn::Set(d, g.b), dy);
    hn::Store(base, d, rows->base + part * kN);
    hn::Store(slope, d, rows->slope + part * kN);
    const VF at = hn::Min(hn::Max(hn::Mul(hn::Set(d, g.peak), slope), first), last);
    const VF most = hn::Add(base, hn::Mul(at, hn::Add(slope, hn::Mul(a, at))));
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::Ge(most, hn::Set(d, g.least)), bits);
    mask |= (bits[0] | static_cast<uint32_t>(bits[1]) << 8) << (part * kN);
  }
  rows->mask = mask & alive;
}

/// The rows that still have a pixel of T ≥ stop.
HWY_INLINE uint32_t LivingRows(const float* transmittance, float stop, uint32_t alive) {
  const DF d;
  const VF least = hn::Set(d, stop);
  for (uint32_t left = alive; left != 0; left &= left - 1) {
    const int row = std::countr_zero(left);
    bool dead = true;
    for (int part = 0; part < kParts; ++part) {
      dead = dead && hn::AllTrue(d, hn::Lt(hn::Load(d, transmittance + row * kTileSize + part * kN), least));
    }
    alive &= ~(static_cast<uint32_t>(dead) << row);
  }
  return alive;
}

void DrawSplats(const SplatList& list, SplatTile* tile) {
  const DF d;
  const VF least = hn::Set(d, kLeastExponent), stop = hn::Set(d, tile->stop);
  const VF largest = hn::Set(d, ScreenGaussians::kLargestAlpha);
  const float left = static_cast<float>(tile->x), top = static_cast<float>(tile->y);
  Rows rows;
  for (int i = 0; i < list.count; ++i) {
    if (i % kEntriesBetweenLooks == 0) {
      tile->alive = LivingRows(tile->transmittance, tile->stop, tile->alive);
      if (tile->alive == 0) return;
    }
    const SplatShape& g = list.shapes[list.ranks[i]];
    FindRows(g, left, top, tile->alive, &rows);
    if (rows.mask == 0) continue;
    const SplatPaint& paint = list.paints[list.ranks[i]];
    VF dx[kParts], adx[kParts];
    for (int part = 0; part < kParts; ++part) {
      dx[part] = hn::Sub(hn::Iota(d, left + static_cast<float>(part * kN)), hn::Set(d, g.x));
      adx[part] = hn::Mul(hn::Set(d, g.a), dx[part]);
    }
    const VF red = hn::Set(d, paint.red), green = hn::Set(d, paint.green), blue = hn::Set(d, paint.blue);
    for (; rows.mask != 0; rows.mask &= rows.mask - 1) {
      const int row = std::countr_zero(rows.mask);
      const VF base = hn::Set(d, rows.base[row]), slope = hn::Set(d, rows.slope[row]);
      for (int part = 0; part < kParts; ++part) {
        const int at = row * kTileSize + part * kN;
        const VF t = hn::Add(base, hn::Mul(dx[part], hn::Add(slope, adx[part])));
        const VF before = hn::Load(d, tile->transmittance + at);
        const MF takes = hn::And(hn::Ge(t, least), hn::Ge(before, stop));
        if (hn::AllFalse(d, takes)) continue;
        const VF w = hn::IfThenElseZero(takes, hn::Mul(hn::Min(largest, Exp2(d, t)), before));
        const auto add = [&](float* to, VF colour)
                             HWY_ATTR { hn::Store(hn::Add(hn::Load(d, to + at), hn::Mul(w, colour)), d, to + at); };
        add(tile->colour[0], red);
        add(tile->colour[1], green);
        add(tile->colour[2], blue);
        hn::Store(hn::Sub(before, w), d, tile->transmittance + at);
      }
    }
  }
}

/// Lanes i, i+4, i+8 and i+12 of sixteen added: (i + (i+8)) + ((i+4) + (i+12)).
HWY_INLINE Quad Fold(const VF* v) {
  const DF d;
  alignas(64) float lanes[kTileSize];
  for (int part = 0; part < kParts; ++part) hn::Store(v[part], d, lanes + part * kN);
  return (LoadQuad(lanes) + LoadQuad(lanes + 8)) + (LoadQuad(lanes + 4) + LoadQuad(lanes + 12));
}

/// Sums of four vectors' lanes.
HWY_INLINE void StoreSums(Quad a, Quad b, Quad c, Quad e, float* to) {
  Transpose(a, b, c, e);
  StoreQuad((a + c) + (b + e), to);
}

void DrawSplatsBackward(const SplatList& list, SplatTileBack* tile, float* sums) {
  const DF d;
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0F), least = hn::Set(d, kLeastExponent),
           stop = hn::Set(d, tile->stop), largest = hn::Set(d, ScreenGaussians::kLargestAlpha);
  const float left = static_cast<float>(tile->x), top = static_cast<float>(tile->y);
  Rows rows;
  for (int i = 0; i < list.count; ++i) {
    float* const to = sums + static_cast<int64_t>(list.slots[i]) * kSlotFloats;
    if (i % kEntriesBetweenLooks == 0 && tile->alive != 0) {
      tile->alive = LivingRows(tile->transmittance, tile->stop, tile->alive);
    }
    rows.mask = 0;
    const SplatShape& g = list.shapes[list.ranks[i]];
    if (tile->alive != 0) FindRows(g, left, top, tile->alive, &rows);
    if (rows.mask == 0) {
      std::fill_n(to, kSlotFloats, 0.0F);
      continue;
    }
    const SplatPaint& paint = list.paints[list.ranks[i]];
    VF dx[kParts], adx[kParts];
    VF sum[kParts], sum_y[kParts], sum_yy[kParts], red_sum[kParts], green_sum[kParts], blue_sum[kParts];
    for (int part = 0; part < kParts; ++part) {
      dx[part] = hn::Sub(hn::Iota(d, left + static_cast<float>(part * kN)), hn::Set(d, g.x));
      adx[part] = hn::Mul(hn::Set(d, g.a), dx[part]);
      sum[part] = sum_y[part] = sum_yy[part] = red_sum[part] = green_sum[part] = blue_sum[part] = zero;
    }
    const VF red = hn::Set(d, paint.red), green = hn::Set(d, paint.green), blue = hn::Set(d, paint.blue);
    for (; rows.mask != 0; rows.mask &= rows.mask - 1) {
      const int row = std::countr_zero(rows.mask);
      const VF base = hn::Set(d, rows.base[row]), slope = hn::Set(d, rows.slope[row]);
      const VF dy = hn::Set(d, static_cast<float>(row) + top - g.y);
      for (int part = 0; part < kParts; ++part) {
        const int at = row * kTileSize + part * kN;
        const VF t = hn::Add(base, hn::Mul(dx[part], hn::Add(slope, adx[part])));
        const VF before = hn::Load(d, tile->transmittance + at);
        const MF takes = hn::And(hn::Ge(t, least), hn::Ge(before, stop));
        if (hn::AllFalse(d, takes)) continue;
        const VF whole = Exp2(d, t), alpha = hn::IfThenElseZero(takes, hn::Min(largest, whole));
        const VF w = hn::Mul(alpha, before);
        hn::Store(hn::Sub(before, w), d, tile->transmittance + at);
        const VF by_red = hn::Load(d, tile->by_colour[0] + at), by_green = hn::Load(d, tile->by_colour[1] + at),
                 by_blue = hn::Load(d, tile->by_colour[2] + at);
        const VF k = hn::Add(hn::Add(hn::Mul(red, by_red), hn::Mul(green, by_green)),
                             hn::Add(hn::Mul(blue, by_blue), hn::Load(d, tile->by_alpha + at)));
        const VF wk = hn::Mul(w, k), rest = hn::Sub(hn::Load(d, tile->rest + at), wk);
        hn::Store(rest, d, tile->rest + at);
        const VF behind = hn::Div(hn::Mul(rest, alpha), hn::Sub(one, alpha));
        const VF by_log = hn::IfThenElseZero(hn::And(takes, hn::Lt(whole, largest)), hn::Sub(wk, behind));
        const VF by_log_y = hn::Mul(by_log, dy);
        sum[part] = hn::Add(sum[part], by_log);
        sum_y[part] = hn::Add(sum_y[part], by_log_y);
        sum_yy[part] = hn::Add(sum_yy[part], hn::Mul(by_log_y, dy));
        red_sum[part] = hn::Add(red_sum[part], hn::Mul(w, by_red));
        green_sum[part] = hn::Add(green_sum[part], hn::Mul(w, by_green));
        blue_sum[part] = hn::Add(blue_sum[part], hn::Mul(w, by_blue));
      }
    }
    VF sum_x[kParts], sum_xx[kParts], sum_xy[kParts];
    for (int part = 0; part < kParts; ++part) {
      sum_x[part] = hn::Mul(sum[part], dx[part]);
      sum_xx[part] = hn::Mul(sum_x[part], dx[part]);
      sum_xy[part] = hn::Mul(sum_y[part], dx[part]);
    }
    StoreSums(Fold(sum), Fold(sum_x), Fold(sum_y), Fold(sum_xx), to);
    StoreSums(Fold(sum_xy), Fold(sum_yy), Fold(red_sum), Fold(green_sum), to + 4);
    const Quad nothing = bodyloom::HWY_NAMESPACE::Fill(0);
    StoreSums(Fold(blue_sum), nothing, nothing, nothing, to + 8);
  }
}

}  // namespace bodyloom::splat_internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bodyloom::splat_internal {

HWY_EXPORT(DrawSplats);
HWY_EXPORT(DrawSplatsBackward);

void DrawSplats(const SplatList& list, SplatTile* tile) { HWY_DYNAMIC_DISPATCH(DrawSplats)(list, tile); }

void DrawSplatsBackward(const SplatList& list, SplatTileBack* tile, float* sums) {
  HWY_DYNAMIC_DISPATCH(DrawSplatsBackward)(list, tile, sums);
}

}  // namespace bodyloom::splat_internal
#endif  // HWY_ONCE
