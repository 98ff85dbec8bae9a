// SPDX-License-Identifier: Apache-2.0
#include "render/raster/raster_simd.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

// Instruction sets without benefit for these loops, and those whose vector size is not known at compile time.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/raster/raster_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bodyloom::raster_internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using DI = hn::CappedTag<int32_t, kLanes>;
using DF = hn::CappedTag<float, kLanes>;
using VI = hn::Vec<DI>;
using VF = hn::Vec<DF>;

/// Projects one register of vertices x, y, z.
template <class D>
HWY_INLINE void ProjectLanes(D d, const Projection& projection, hn::Vec<D> x, hn::Vec<D> y, hn::Vec<D> z, int first,
                             const ScreenArrays& screen, hn::Vec<hn::Rebind<int32_t, D>>* x_snapped,
                             hn::Vec<hn::Rebind<int32_t, D>>* y_snapped, hn::Mask<D>* finite) {
  const hn::Rebind<int32_t, D> di;
  const hn::Rebind<float, D> df;
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0);
  const auto nothing = hn::Add(hn::Add(hn::Sub(x, x), hn::Sub(y, y)), hn::Sub(z, z));  // NaN unless all are finite
  *finite = hn::Eq(nothing, zero);
  auto ok = *finite;
  auto w = one, nearness = hn::Neg(z);
  if (projection.divide_by_depth) {
    ok = hn::And(ok, hn::Ge(z, hn::Set(d, projection.near_m)));
    w = nearness = hn::Div(one, hn::IfThenElse(ok, z, one));
  }
  const auto x_px =
      hn::Add(hn::Mul(hn::Set(d, projection.scale_x), hn::Add(hn::Mul(x, w), hn::Set(d, projection.offset_x))),
              hn::Set(d, projection.centre_x));
  const auto y_px =
      hn::Add(hn::Mul(hn::Set(d, projection.scale_y), hn::Add(hn::Mul(y, w), hn::Set(d, projection.offset_y))),
              hn::Set(d, projection.centre_y));
  const auto guard = hn::Set(d, kGuardBandPx);
  ok = hn::And(ok, hn::And(hn::Lt(hn::Abs(x_px), guard), hn::Lt(hn::Abs(y_px), guard)));
  const auto subpixels = hn::Set(d, double{kSubpixels}), half = hn::Set(d, 0.5);
  const auto snapped = [&](auto px) HWY_ATTR {
    return hn::Floor(hn::Add(hn::Mul(hn::IfThenElseZero(ok, px), subpixels), half));
  };
  const auto unknown = hn::Set(d, std::numeric_limits<double>::quiet_NaN());
  hn::StoreInterleaved4(x_px, y_px, hn::IfThenElse(ok, nearness, unknown), zero, d, &screen.projected[first].x_px);
  *x_snapped = hn::DemoteTo(di, hn::IfThenElse(ok, snapped(x_px), hn::Set(d, double{kUnusable})));
  *y_snapped = hn::DemoteTo(di, snapped(y_px));
  const auto nearness_bits = hn::BitCast(di, hn::DemoteTo(df, nearness));
  hn::StoreInterleaved4(*x_snapped, *y_snapped, nearness_bits, hn::Zero(di), di,
                        reinterpret_cast<int32_t*>(screen.vertices + first));
}

void ProjectVertices(const Projection& projection, const double* vertices, int first, int last,
                     const ScreenArrays& screen, ScreenExtent* extent) {
  const hn::CappedTag<double, kLanes / 2> d;
  const hn::Rebind<int32_t, decltype(d)> di;
  const int N = static_cast<int>(hn::Lanes(d));
  bool all_usable = true, all_finite = true;
  auto x_min = hn::Set(di, INT32_MAX), x_max = hn::Set(di, INT32_MIN), y_min = x_min, y_max = x_max;
  double tail[3 * kLanes];
  for (int v = first; v < last; v += N) {
    const double* from = vertices + 3 * static_cast<int64_t>(v);
    if (v + N > last) {  // missing lanes repeat the last vertex
      for (int i = 0; i < 3 * N; ++i) tail[i] = from[std::min(i / 3, last - v - 1) * 3 + i % 3];
      from = tail;
    }
    hn::Vec<decltype(d)> x, y, z;
    hn::LoadInterleaved3(d, from, x, y, z);
    hn::Vec<decltype(di)> xs, ys;
    hn::Mask<decltype(d)> finite;
    ProjectLanes(d, projection, x, y, z, v, screen, &xs, &ys, &finite);
    all_finite = all_finite && hn::AllTrue(d, finite);
    const auto off = hn::Eq(xs, hn::Set(di, kUnusable));
    all_usable = all_usable && hn::AllFalse(di, off);
    x_min = hn::Min(x_min, hn::IfThenElse(off, x_min, xs));
    x_max = hn::Max(x_max, hn::IfThenElse(off, x_max, xs));
    y_min = hn::Min(y_min, hn::IfThenElse(off, y_min, ys));
    y_max = hn::Max(y_max, hn::IfThenElse(off, y_max, ys));
  }
  extent->all_usable = extent->all_usable && all_usable;
  extent->all_finite = extent->all_finite && all_finite;
  extent->x_min = std::min(extent->x_min, hn::GetLane(hn::MinOfLanes(di, x_min)));
  extent->x_max = std::max(extent->x_max, hn::GetLane(hn::MaxOfLanes(di, x_max)));
  extent->y_min = std::min(extent->y_min, hn::GetLane(hn::MinOfLanes(di, y_min)));
  extent->y_max = std::max(extent->y_max, hn::GetLane(hn::MaxOfLanes(di, y_max)));
}

bool AllInRange(const int32_t* values, int64_t count, int32_t bound) {
  const hn::CappedTag<int32_t, kLanes> d;
  const int64_t N = hn::Lanes(d);
  auto low = hn::Zero(d), high = hn::Zero(d);
  int64_t i = 0;
  for (; i + N <= count; i += N) {
    const auto v = hn::LoadU(d, values + i);
    low = hn::Min(low, v), high = hn::Max(high, v);
  }
  bool ok = count == 0 || (hn::GetLane(hn::MinOfLanes(d, low)) >= 0 && hn::GetLane(hn::MaxOfLanes(d, high)) < bound);
  for (; i < count; ++i) ok = ok && values[i] >= 0 && values[i] < bound;
  return ok;
}

HWY_INLINE void Append(DI d, VI v, hn::Mask<DI> mask, int32_t* to) { hn::StoreU(hn::Compress(v, mask), d, to); }
HWY_INLINE void Append(DF d, VF v, hn::Mask<DF> mask, float* to) { hn::StoreU(hn::Compress(v, mask), d, to); }

void SetUpFaces(const int32_t* faces, int first, int last, const ScreenArrays& screen, const Box& box,
                bool cull_back_faces, SmallFaces* small, std::vector<int32_t>* others) {
  const DI d;
  const DF df;
  const int N = static_cast<int>(hn::Lanes(d));
  const auto zero = hn::Zero(d);
  const int32_t* screen_x = &screen.vertices->x;  // y and nearness follow
  int32_t tail[3 * kLanes];
  for (int f = first; f < last; f += N) {
    const int32_t* from = faces + 3 * static_cast<int64_t>(f);
    const int count = std::min(N, last - f);
    if (count < N) {  // missing lanes repeat the last face
      for (int i = 0; i < 3 * N; ++i) tail[i] = from[std::min(i / 3, count - 1) * 3 + i % 3];
      from = tail;
    }
    VI ia, ib, ic;
    hn::LoadInterleaved3(d, from, ia, ib, ic);
    ia = hn::ShiftLeft<2>(ia), ib = hn::ShiftLeft<2>(ib), ic = hn::ShiftLeft<2>(ic);
    const VI ax = hn::GatherIndex(d, screen_x, ia), ay = hn::GatherIndex(d, screen_x + 1, ia);
    VI bx = hn::GatherIndex(d, screen_x, ib), by = hn::GatherIndex(d, screen_x + 1, ib);
    VI cx = hn::GatherIndex(d, screen_x, ic), cy = hn::GatherIndex(d, screen_x + 1, ic);

    // Mask of the faces drawn here. Coordinates of unusable corners are undefined.
    const VI unusable = hn::Set(d, kUnusable);
    const auto broken = hn::Or(hn::Eq(ax, unusable), hn::Or(hn::Eq(bx, unusable), hn::Eq(cx, unusable)));
    const VI x_min = hn::Min(ax, hn::Min(bx, cx)), x_max = hn::Max(ax, hn::Max(bx, cx));
    const VI y_min = hn::Min(ay, hn::Min(by, cy)), y_max = hn::Max(ay, hn::Max(by, cy));
    const VI round_up = hn::Set(d, kSubpixels - 1);
    const VI x_begin = hn::Max(hn::Sub(hn::ShiftRight<8>(hn::Add(x_min, round_up)), hn::Set(d, box.x_begin)), zero);
    const VI y_begin = hn::Max(hn::Sub(hn::ShiftRight<8>(hn::Add(y_min, round_up)), hn::Set(d, box.y_begin)), zero);
    const VI x_end = hn::Min(hn::Sub(hn::ShiftRight<8>(x_max), hn::Set(d, box.x_begin - 1)), hn::Set(d, box.width));
    const VI y_end = hn::Min(hn::Sub(hn::ShiftRight<8>(y_max), hn::Set(d, box.y_begin - 1)), hn::Set(d, box.height));
    auto drawn = hn::And(hn::Lt(x_begin, x_end), hn::Lt(y_begin, y_end));
    // Edge values must fit 31 bits up to 31 px beyond the face, as vectors are aligned.
    const VF reach_x = hn::ConvertTo(df, hn::Add(hn::Sub(x_max, x_min), hn::Set(d, 34 * kSubpixels)));
    const VF reach_y = hn::ConvertTo(df, hn::Add(hn::Sub(y_max, y_min), hn::Set(d, 2 * kSubpixels)));
    const auto fits = hn::RebindMask(d, hn::Lt(hn::Mul(reach_x, reach_y), hn::Set(df, 1.07e9F)));

    const VI ux = hn::Sub(bx, ax), uy = hn::Sub(by, ay), vx = hn::Sub(cx, ax), vy = hn::Sub(cy, ay);
    VI area = hn::Sub(hn::Mul(ux, vy), hn::Mul(uy, vx));  // valid where it fits
    const auto is_front = hn::Lt(area, zero);             // y is down: counter-clockwise is negative
    auto faces_us = cull_back_faces ? is_front : hn::Ne(area, zero);
    const auto exists = hn::FirstN(d, count);
    const auto is_small = hn::And(hn::AndNot(broken, exists), hn::And(drawn, hn::And(fits, faces_us)));
    const auto is_other = hn::And(exists, hn::Or(broken, hn::AndNot(fits, drawn)));
    if (!hn::AllFalse(d, is_other)) {
      uint8_t bits[8] = {};
      hn::StoreMaskBits(d, is_other, bits);
      for (int i = 0; i < count; ++i) {
        if ((bits[i / 8] >> (i % 8)) & 1) others->push_back(f + i);
      }
    }
    if (hn::AllFalse(d, is_small)) continue;

    const VF na = hn::BitCast(df, hn::GatherIndex(d, screen_x + 2, ia));
    VF nb = hn::BitCast(df, hn::GatherIndex(d, screen_x + 2, ib));
    VF nc = hn::BitCast(df, hn::GatherIndex(d, screen_x + 2, ic));
    const auto swap = [](auto mask, auto& p, auto& q) HWY_ATTR {
      const auto first_value = p;
      p = hn::IfThenElse(mask, q, p);
      q = hn::IfThenElse(mask, first_value, q);
    };
    swap(is_front, bx, cx);
    swap(is_front, by, cy);
    swap(hn::RebindMask(df, is_front), nb, nc);
    area = hn::Abs(area);

    const int at = small->size;
    const VI px = hn::ShiftLeft<8>(hn::Add(x_begin, hn::Set(d, box.x_begin)));
    const VI py = hn::ShiftLeft<8>(hn::Add(y_begin, hn::Set(d, box.y_begin)));
    const auto edge = [&](int k, VI from_x, VI from_y, VI to_x, VI to_y) HWY_ATTR {
      const VI dx = hn::Sub(to_x, from_x), dy = hn::Sub(to_y, from_y);
      // Left edges (inside lies to the right) and horizontal top ones own their pixels.
      const auto owns = hn::Or(hn::Lt(dy, zero), hn::And(hn::Eq(dy, zero), hn::Gt(dx, zero)));
      const VI bias = hn::IfThenElse(owns, zero, hn::Set(d, 1));
      const VI value = hn::Sub(hn::Mul(dx, hn::Sub(py, from_y)), hn::Mul(dy, hn::Sub(px, from_x)));
      Append(d, hn::Sub(value, bias), is_small, small->edge[k] + at);
      Append(d, hn::ShiftLeft<8>(hn::Neg(dy)), is_small, small->step_x[k] + at);
      Append(d, hn::ShiftLeft<8>(dx), is_small, small->step_y[k] + at);
      return hn::ConvertTo(df, bias);
    };
    edge(0, bx, by, cx, cy);
    const VF bias_b = edge(1, cx, cy, ax, ay), bias_c = edge(2, ax, ay, bx, by);
    const VF float_area = hn::ConvertTo(df, hn::IfThenElse(is_small, area, hn::Set(d, 1)));
    const VF slope_b = hn::Div(hn::Sub(nb, na), float_area), slope_c = hn::Div(hn::Sub(nc, na), float_area);
    const auto is_small_f = hn::RebindMask(df, is_small);
    Append(df, hn::Add(na, hn::Add(hn::Mul(bias_b, slope_b), hn::Mul(bias_c, slope_c))), is_small_f,
           small->anchor + at);
    Append(df, slope_b, is_small_f, small->slope_b + at);
    Append(df, slope_c, is_small_f, small->slope_c + at);
    Append(d, x_begin, is_small, small->x_begin + at);
    Append(d, y_begin, is_small, small->y_begin + at);
    Append(d, x_end, is_small, small->x_end + at);
    Append(d, y_end, is_small, small->y_end + at);
    Append(d, hn::Iota(d, f), is_small, small->face + at);
    small->size += static_cast<int>(hn::CountTrue(d, is_small));
  }
}

void ClearTile(Tile* tile) {
  const DI d;
  const DF df;
  const int N = static_cast<int>(hn::Lanes(d));
  const VF far = hn::Set(df, -std::numeric_limits<float>::infinity());
  const VI none = hn::Set(d, -1);
  for (int i = 0; i < kTileWidth * kTileHeight; i += N) {
    hn::Store(far, df, tile->nearness + i);
    hn::Store(none, d, tile->face + i);
  }
}

void DrawSmallFaces(const SmallFaces& faces, const int32_t* entries, int count, Tile* tile) {
  const DI d;
  const DF df;
  const int N = static_cast<int>(hn::Lanes(d));
  const VI iota = hn::Iota(d, 0);
  for (int i = 0; i < count; ++i) {
    const int k = entries[i];
    const int x_first = faces.x_begin[k], y_first = faces.y_begin[k];
    const int x_begin = std::max(x_first - tile->x, 0) & -N;  // vectors are aligned
    const int x_end = std::min(faces.x_end[k] - tile->x, kTileWidth);
    const int y_begin = std::max(y_first - tile->y, 0), y_end = std::min(faces.y_end[k] - tile->y, kTileHeight);
    const int right = tile->x + x_begin - x_first, down = tile->y + y_begin - y_first;
    VI row[3], step_y[3];
    int32_t step_x[3];
    for (int c = 0; c < 3; ++c) {
      step_x[c] = faces.step_x[c][k];
      step_y[c] = hn::Set(d, faces.step_y[c][k]);
      row[c] = hn::Add(hn::Set(d, faces.edge[c][k] + right * step_x[c] + down * faces.step_y[c][k]),
                       hn::Mul(iota, hn::Set(d, step_x[c])));
    }
    const VF anchor = hn::Set(df, faces.anchor[k]), slope_b = hn::Set(df, faces.slope_b[k]),
             slope_c = hn::Set(df, faces.slope_c[k]);
    const VI face = hn::Set(d, faces.face[k]);
    const auto draw = [&](VI ea, VI eb, VI ec, int at) HWY_ATTR {
      const auto inside = hn::Gt(hn::Or(hn::Or(ea, eb), ec), hn::Set(d, -1));
      if (hn::AllFalse(d, inside)) return;
      const VF nearness =
          hn::Add(anchor, hn::Add(hn::Mul(hn::ConvertTo(df, eb), slope_b), hn::Mul(hn::ConvertTo(df, ec), slope_c)));
      const VF before = hn::Load(df, tile->nearness + at);
      const auto wins = hn::And(hn::RebindMask(df, inside), hn::Gt(nearness, before));
      hn::Store(hn::IfThenElse(wins, nearness, before), df, tile->nearness + at);
      hn::Store(hn::IfThenElse(hn::RebindMask(d, wins), face, hn::Load(d, tile->face + at)), d, tile->face + at);
    };
    for (int y = y_begin; y < y_end; ++y) {
      const int at = y * kTileWidth + x_begin;
      draw(row[0], row[1], row[2], at);
      if (x_end - x_begin > N) {
        VI ea = row[0], eb = row[1], ec = row[2];
        for (int x = N; x < x_end - x_begin; x += N) {
          ea = hn::Add(ea, hn::Set(d, N * step_x[0]));
          eb = hn::Add(eb, hn::Set(d, N * step_x[1]));
          ec = hn::Add(ec, hn::Set(d, N * step_x[2]));
          draw(ea, eb, ec, at + x);
        }
      }
      row[0] = hn::Add(row[0], step_y[0]);
      row[1] = hn::Add(row[1], step_y[1]);
      row[2] = hn::Add(row[2], step_y[2]);
    }
  }
}

int64_t FloorDivide(int64_t a, int64_t b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

/// One row of a large face: columns x_begin..x_end−1 of the tile, edge values and nearness exact up to rounding.
struct LargeRow {
  int64_t eb, ec;  ///< unbiased, at column 0
  int64_t step_b, step_c;
  double anchor, slope_b, slope_c;
  int32_t face;
};

HWY_INLINE void DrawLargeRow(const LargeRow& row, int x_begin, int x_end, float* nearness_row, int32_t* face_row) {
  const hn::CappedTag<double, kLanes / 2> d;
  const hn::Rebind<int64_t, decltype(d)> dl;
  const hn::Rebind<float, decltype(d)> df;
  const hn::Rebind<int32_t, decltype(d)> di;
  const int N = static_cast<int>(hn::Lanes(d));
  const auto face = hn::Set(di, row.face);
  for (int x = x_begin & -N; x < x_end; x += N) {
    HWY_ALIGN int64_t b[kLanes / 2], c[kLanes / 2];
    for (int i = 0; i < N; ++i) {
      b[i] = row.eb + (x + i) * row.step_b;
      c[i] = row.ec + (x + i) * row.step_c;
    }
    const auto eb = hn::ConvertTo(d, hn::Load(dl, b)), ec = hn::ConvertTo(d, hn::Load(dl, c));
    const auto sum = hn::Add(hn::Mul(eb, hn::Set(d, row.slope_b)), hn::Mul(ec, hn::Set(d, row.slope_c)));
    const auto nearness = hn::DemoteTo(df, hn::Add(hn::Set(d, row.anchor), sum));
    const auto before = hn::Load(df, nearness_row + x);
    const auto face_before = hn::Load(di, face_row + x);
    const auto column = hn::Iota(di, x);
    const auto inside = hn::And(hn::Gt(column, hn::Set(di, x_begin - 1)), hn::Lt(column, hn::Set(di, x_end)));
    const auto nearer = hn::RebindMask(di, hn::Gt(nearness, before));
    const auto tied = hn::And(hn::RebindMask(di, hn::Eq(nearness, before)), hn::Lt(face, face_before));
    const auto wins = hn::And(inside, hn::Or(nearer, tied));
    hn::Store(hn::IfThenElse(hn::RebindMask(df, wins), nearness, before), df, nearness_row + x);
    hn::Store(hn::IfThenElse(wins, face, face_before), di, face_row + x);
  }
}

void DrawLargeFaces(const LargeFace* faces, const int32_t* entries, int count, const Box& box, bool cull_back_faces,
                    Tile* tile) {
  const int64_t left = static_cast<int64_t>(box.x_begin + tile->x) * kSubpixels;
  const int64_t top = static_cast<int64_t>(box.y_begin + tile->y) * kSubpixels;
  const int width = std::min(kTileWidth, box.width - tile->x), height = std::min(kTileHeight, box.height - tile->y);
  for (int i = 0; i < count; ++i) {
    const LargeFace& f = faces[entries[i]];
    ScreenVertex corner[3] = {f.corners[0], f.corners[1], f.corners[2]};
    const auto edge_value = [](const ScreenVertex& p, const ScreenVertex& q, int64_t x, int64_t y) {
      return (int64_t{q.x} - p.x) * (y - p.y) - (int64_t{q.y} - p.y) * (x - p.x);
    };
    int64_t area = edge_value(corner[0], corner[1], corner[2].x, corner[2].y);
    if (area == 0 || (area > 0 && cull_back_faces)) continue;
    if (area < 0) {
      std::swap(corner[1], corner[2]);
      area = -area;
    }
    int64_t edge[3], step_x[3], step_y[3], bias[3];
    for (int k = 0; k < 3; ++k) {
      const ScreenVertex &p = corner[(k + 1) % 3], &q = corner[(k + 2) % 3];
      const int64_t dx = int64_t{q.x} - p.x, dy = int64_t{q.y} - p.y;
      bias[k] = dy < 0 || (dy == 0 && dx > 0) ? 0 : 1;
      edge[k] = edge_value(p, q, left, top) - bias[k];
      step_x[k] = -dy * kSubpixels;
      step_y[k] = dx * kSubpixels;
    }
    const double na = corner[0].nearness;
    LargeRow row;
    row.slope_b = (double{corner[1].nearness} - na) / static_cast<double>(area);
    row.slope_c = (double{corner[2].nearness} - na) / static_cast<double>(area);
    row.anchor = na + (static_cast<double>(bias[1]) * row.slope_b + static_cast<double>(bias[2]) * row.slope_c);
    row.step_b = step_x[1], row.step_c = step_x[2];
    row.face = f.face;
    for (int y = 0; y < height; ++y) {
      int64_t x_begin = 0, x_end = width;
      for (int k = 0; k < 3; ++k) {  // where the edge's value is not negative
        if (step_x[k] > 0) {
          x_begin = std::max(x_begin, -FloorDivide(edge[k], step_x[k]));
        } else if (step_x[k] < 0) {
          x_end = std::min(x_end, FloorDivide(edge[k], -step_x[k]) + 1);
        } else if (edge[k] < 0) {
          x_end = 0;
        }
      }
      if (x_begin < x_end) {
        row.eb = edge[1], row.ec = edge[2];
        DrawLargeRow(row, static_cast<int>(x_begin), static_cast<int>(x_end), tile->nearness + y * kTileWidth,
                     tile->face + y * kTileWidth);
      }
      for (int k = 0; k < 3; ++k) edge[k] += step_y[k];
    }
  }
}

int64_t CompiledFor() { return HWY_TARGET; }

}  // namespace bodyloom::raster_internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bodyloom::raster_internal {

HWY_EXPORT(ProjectVertices);
HWY_EXPORT(AllInRange);
HWY_EXPORT(SetUpFaces);
HWY_EXPORT(ClearTile);
HWY_EXPORT(DrawSmallFaces);
HWY_EXPORT(DrawLargeFaces);
HWY_EXPORT(CompiledFor);

void SmallFaces::Reserve(int num_faces) {
  const size_t stride = static_cast<size_t>(num_faces) + kLanes;
  integers.resize(14 * stride);
  reals.resize(3 * stride);
  int32_t* next = integers.data();
  for (int32_t** array : {&x_begin, &y_begin, &x_end, &y_end, &edge[0], &edge[1], &edge[2], &step_x[0], &step_x[1],
                          &step_x[2], &step_y[0], &step_y[1], &step_y[2], &face}) {
    *array = std::exchange(next, next + stride);
  }
  anchor = reals.data(), slope_b = anchor + stride, slope_c = slope_b + stride;
  size = 0;
}

void ProjectVertices(const Projection& projection, const double* vertices, int first, int last,
                     const ScreenArrays& screen, ScreenExtent* extent) {
  HWY_DYNAMIC_DISPATCH(ProjectVertices)(projection, vertices, first, last, screen, extent);
}

bool AllInRange(const int32_t* values, int64_t count, int32_t bound) {
  return HWY_DYNAMIC_DISPATCH(AllInRange)(values, count, bound);
}

void SetUpFaces(const int32_t* faces, int first, int last, const ScreenArrays& screen, const Box& box,
                bool cull_back_faces, SmallFaces* small, std::vector<int32_t>* others) {
  HWY_DYNAMIC_DISPATCH(SetUpFaces)(faces, first, last, screen, box, cull_back_faces, small, others);
}

void ClearTile(Tile* tile) { HWY_DYNAMIC_DISPATCH(ClearTile)(tile); }

void DrawSmallFaces(const SmallFaces& faces, const int32_t* entries, int count, Tile* tile) {
  HWY_DYNAMIC_DISPATCH(DrawSmallFaces)(faces, entries, count, tile);
}

void DrawLargeFaces(const LargeFace* faces, const int32_t* entries, int count, const Box& box, bool cull_back_faces,
                    Tile* tile) {
  HWY_DYNAMIC_DISPATCH(DrawLargeFaces)(faces, entries, count, box, cull_back_faces, tile);
}

std::vector<int64_t> SimdTargets() { return hwy::SupportedAndGeneratedTargets(); }

std::string SimdTargetName(int64_t target) { return hwy::TargetName(target); }

std::string ChosenSimdTarget() { return hwy::TargetName(HWY_DYNAMIC_DISPATCH(CompiledFor)()); }

void ForceSimdTarget(int64_t target) { hwy::SetSupportedTargetsForTest(target); }

}  // namespace bodyloom::raster_internal
#endif  // HWY_ONCE
