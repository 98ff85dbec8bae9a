// SPDX-License-Identifier: Apache-2.0
#include "render/splat/splat_simd.h"

#include <algorithm>
#include <bit>

#include "render/splat/camera_gaussians.h"

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/splat/splat_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "geometry/math/quad-inl.h"
#include "render/splat/float_math-inl.h"

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
constexpr int kParts = kBlockPixels / kN;  ///< vectors per block
constexpr int kEntriesBetweenLooks = 8;
constexpr int kEntriesAhead = 6;  ///< prefetch distance: a tile's Gaussians lie far apart in memory

/// Broadcasts four column values to the lanes of a block's part: lane i gets that of column i mod 4.
HWY_INLINE VF ByColumn(const float* columns, int part) {
  return hn::LoadDup128(DF(), columns + part * kN % kBlockSize);
}

/// The blocks of the tile that a Gaussian may cover, and the exponent's constants per column of the tile.
struct Reach {
  uint32_t blocks;
  alignas(64) float dx[kTileSize];
  alignas(64) float base[kTileSize];   ///< log2 o + a d_x²
  alignas(64) float slope[kTileSize];  ///< b d_x
};

/// Pixel rows of the tile per lane and row of blocks, and the corners of its blocks.
struct TileGrid {
  alignas(64) float y[kBlocksAcross][kBlockPixels];
  alignas(64) float left[kNumBlocks], top[kNumBlocks];
  HWY_INLINE TileGrid(int tile_x, int tile_y) {
    for (int i = 0; i < kBlocksAcross * kBlockPixels; ++i) {
      const int row = tile_y + i / kBlockSize;
      y[i / kBlockPixels][i % kBlockPixels] = static_cast<float>(row);
    }
    for (int b = 0; b < kNumBlocks; ++b) {
      const int x = tile_x + b % kBlocksAcross * kBlockSize, row = tile_y + b / kBlocksAcross * kBlockSize;
      left[b] = static_cast<float>(x);
      top[b] = static_cast<float>(row);
    }
  }
};

/// The exponent is concave: over a block without the mean its maximum lies on an edge that faces the mean, the vertical
/// one at d_x = nearest column or the horizontal one at d_y = nearest row.
HWY_INLINE uint32_t BlocksReached(const Splat& g, const TileGrid& grid) {
  const DF d;
  const VF zero = hn::Zero(d), width = hn::Set(d, kBlockSize - 1.0F);
  const VF a = hn::Set(d, g.a), b = hn::Set(d, g.b), c = hn::Set(d, g.c);
  const auto within = [&](VF value, VF low, VF high) HWY_ATTR { return hn::Min(hn::Max(value, low), high); };
  uint32_t mask = 0;
  for (int first = 0; first < kNumBlocks; first += kN) {
    const VF left = hn::Sub(hn::Load(d, grid.left + first), hn::Set(d, g.x)), right = hn::Add(left, width);
    const VF top = hn::Sub(hn::Load(d, grid.top + first), hn::Set(d, g.y)), bottom = hn::Add(top, width);
    const VF x = within(zero, left, right), y = within(zero, top, bottom);
    const VF bx = hn::Mul(b, x), by = hn::Mul(b, y);
    const VF best_y = within(hn::Mul(bx, hn::Set(d, g.peak_y)), top, bottom);
    const VF best_x = within(hn::Mul(by, hn::Set(d, g.peak_x)), left, right);
    const VF upright = hn::Add(hn::Mul(a, hn::Mul(x, x)), hn::Mul(best_y, hn::Add(bx, hn::Mul(c, best_y))));
    const VF level = hn::Add(hn::Mul(c, hn::Mul(y, y)), hn::Mul(best_x, hn::Add(by, hn::Mul(a, best_x))));
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::Ge(hn::Max(upright, level), hn::Set(d, g.minimum)), bits);
    mask |= (bits[0] | static_cast<uint32_t>(bits[1]) << 8) << first;
  }
  return mask;
}

HWY_INLINE void FindReach(const Splat& g, const TileGrid& grid, int left, uint32_t alive, Reach* reach) {
  const DF d;
  reach->blocks = BlocksReached(g, grid) & alive;
  if (reach->blocks == 0) return;
  for (int column = 0; column < kTileSize; column += kN) {
    const VF dx = hn::Sub(hn::Iota(d, static_cast<float>(left + column)), hn::Set(d, g.x));
    hn::Store(dx, d, reach->dx + column);
    const VF square = hn::Mul(dx, dx);
    hn::Store(hn::Add(hn::Set(d, g.log2_opacity), hn::Mul(hn::Set(d, g.a), square)), d, reach->base + column);
    hn::Store(hn::Mul(hn::Set(d, g.b), dx), d, reach->slope + column);
  }
}

/// The blocks that still have a pixel of T ≥ stop.
HWY_INLINE uint32_t LivingBlocks(const float* transmittance, float stop, uint32_t alive) {
  const DF d;
  const VF minimum = hn::Set(d, stop);
  for (uint32_t left = alive; left != 0; left &= left - 1) {
    const int block = std::countr_zero(left);
    bool dead = true;
    for (int part = 0; part < kParts; ++part) {
      dead = dead && hn::AllTrue(d, hn::Lt(hn::Load(d, transmittance + block * kBlockPixels + part * kN), minimum));
    }
    alive &= ~(static_cast<uint32_t>(dead) << block);
  }
  return alive;
}

HWY_INLINE void FetchAhead(const SplatList& list, int i) {
  if (i + kEntriesAhead < list.count) hwy::Prefetch(list.splats + list.entries[i + kEntriesAhead].row);
}

/// For the pixels of a part of a block from `column` on: the Gaussian's exponent of 2 and a mask of the pixels that use
/// it. Shared by both passes, so that derivatives match the rendered image.
struct Taking {
  VF t;
  MF takes;
};
HWY_INLINE Taking TakenBy(const Reach& reach, int column, int part, VF c, VF dy, VF before, VF stop) {
  const VF line = hn::Add(ByColumn(reach.slope + column, part), hn::Mul(c, dy));
  const VF t = hn::Add(ByColumn(reach.base + column, part), hn::Mul(dy, line));
  return {t, hn::And(hn::Ge(t, hn::Set(DF(), kMinExponent)), hn::Ge(before, stop))};
}

void DrawSplats(const SplatList& list, SplatTile* tile) {
  const DF d;
  const VF stop = hn::Set(d, tile->stop);
  const VF largest = hn::Set(d, ScreenGaussians::kLargestAlpha);
  const TileGrid grid(tile->x, tile->y);
  Reach reach;
  for (int i = 0; i < list.count; ++i) {
    FetchAhead(list, i);
    if (i % kEntriesBetweenLooks == 0) {
      tile->alive = LivingBlocks(tile->transmittance, tile->stop, tile->alive);
      if (tile->alive == 0) return;
    }
    const Splat& g = list.splats[list.entries[i].row];
    FindReach(g, grid, tile->x, tile->alive, &reach);
    if (reach.blocks == 0) continue;
    const VF mean_y = hn::Set(d, g.y), c = hn::Set(d, g.c);
    const VF red = hn::Set(d, g.red), green = hn::Set(d, g.green), blue = hn::Set(d, g.blue);
    for (uint32_t left = reach.blocks; left != 0; left &= left - 1) {
      const int block = std::countr_zero(left), column = block % kBlocksAcross * kBlockSize;
      for (int part = 0; part < kParts; ++part) {
        const int at = block * kBlockPixels + part * kN;
        const VF dy = hn::Sub(hn::Load(d, grid.y[block / kBlocksAcross] + part * kN), mean_y);
        const VF before = hn::Load(d, tile->transmittance + at);
        const auto [t, takes] = TakenBy(reach, column, part, c, dy, before, stop);
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

/// Adds lanes i, i+4, i+8 and i+12 of sixteen: (i + (i+8)) + ((i+4) + (i+12)).
template <class D>
HWY_INLINE Quad Fold(D d, const hn::Vec<D>* v) {
#if HWY_TARGET == HWY_SCALAR
  return bodyloom::HWY_NAMESPACE::ByLane(
      [&](int i) { return hn::GetLane(hn::Add(hn::Add(v[i], v[i + 8]), hn::Add(v[i + 4], v[i + 12]))); });
#else
  const hn::Half<D> half;
  if constexpr (hn::MaxLanes(D()) == 16) {
    const hn::Half<hn::Half<D> > quarter;
    const auto sum = hn::Add(hn::LowerHalf(half, v[0]), hn::UpperHalf(half, v[0]));
    return {hn::Add(hn::LowerHalf(quarter, sum), hn::UpperHalf(quarter, sum))};
  } else if constexpr (hn::MaxLanes(D()) == 8) {
    const auto sum = hn::Add(v[0], v[1]);
    return {hn::Add(hn::LowerHalf(half, sum), hn::UpperHalf(half, sum))};
  } else {
    return {hn::Add(hn::Add(v[0], v[2]), hn::Add(v[1], v[3]))};
  }
#endif
}

/// Stores the sums over the lanes of four vectors.
HWY_INLINE void StoreSums(Quad a, Quad b, Quad c, Quad e, float* to) {
  Transpose(a, b, c, e);
  StoreQuad((a + c) + (b + e), to);
}

enum Sum : int { kD, kDx, kDy, kDxx, kDxy, kDyy, kWRed, kWGreen, kWBlue, kNumSums };

void DrawSplatsBackward(const SplatList& list, SplatTileBack* tile, float* sums) {
  const DF d;
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0F), stop = hn::Set(d, tile->stop),
           largest = hn::Set(d, ScreenGaussians::kLargestAlpha);
  const TileGrid grid(tile->x, tile->y);
  Reach reach;
  for (int i = 0; i < list.count; ++i) {
    FetchAhead(list, i);
    float* const to = sums + static_cast<int64_t>(list.entries[i].slot) * kSlotFloats;
    if (i % kEntriesBetweenLooks == 0 && tile->alive != 0) {
      tile->alive = LivingBlocks(tile->transmittance, tile->stop, tile->alive);
    }
    reach.blocks = 0;
    const Splat& g = list.splats[list.entries[i].row];
    if (tile->alive != 0) FindReach(g, grid, tile->x, tile->alive, &reach);
    if (reach.blocks == 0) {
      std::fill_n(to, kSlotFloats, 0.0F);
      continue;
    }
    const VF mean_y = hn::Set(d, g.y), c = hn::Set(d, g.c);
    const VF red = hn::Set(d, g.red), green = hn::Set(d, g.green), blue = hn::Set(d, g.blue);
    VF sum[kNumSums][kParts];
    for (int k = 0; k < kNumSums; ++k) {
      for (int part = 0; part < kParts; ++part) sum[k][part] = zero;
    }
    for (uint32_t left = reach.blocks; left != 0; left &= left - 1) {
      const int block = std::countr_zero(left), column = block % kBlocksAcross * kBlockSize;
      for (int part = 0; part < kParts; ++part) {
        const int at = block * kBlockPixels + part * kN;
        const VF dy = hn::Sub(hn::Load(d, grid.y[block / kBlocksAcross] + part * kN), mean_y);
        const VF before = hn::Load(d, tile->transmittance + at);
        const auto [t, takes] = TakenBy(reach, column, part, c, dy, before, stop);
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
        const VF dx = ByColumn(reach.dx + column, part);
        const VF by_log_x = hn::Mul(by_log, dx), by_log_y = hn::Mul(by_log, dy);
        const auto add = [&](Sum to_sum, VF more) HWY_ATTR { sum[to_sum][part] = hn::Add(sum[to_sum][part], more); };
        add(kD, by_log);
        add(kDx, by_log_x);
        add(kDy, by_log_y);
        add(kDxx, hn::Mul(by_log_x, dx));
        add(kDxy, hn::Mul(by_log_x, dy));
        add(kDyy, hn::Mul(by_log_y, dy));
        add(kWRed, hn::Mul(w, by_red));
        add(kWGreen, hn::Mul(w, by_green));
        add(kWBlue, hn::Mul(w, by_blue));
      }
    }
    StoreSums(Fold(d, sum[kD]), Fold(d, sum[kDx]), Fold(d, sum[kDy]), Fold(d, sum[kDxx]), to);
    StoreSums(Fold(d, sum[kDxy]), Fold(d, sum[kDyy]), Fold(d, sum[kWRed]), Fold(d, sum[kWGreen]), to + 4);
    const Quad nothing = bodyloom::HWY_NAMESPACE::Fill(0);
    StoreSums(Fold(d, sum[kWBlue]), nothing, nothing, nothing, to + 8);
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
