// SPDX-License-Identifier: Apache-2.0
#include "render/raster/resolve_simd.h"

#include <cmath>

#include "render/raster/raster_simd.h"

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/raster/resolve_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bodyloom::resolve_internal::HWY_NAMESPACE {

/// Values of corners a, b, c and padding: loops over all four become one instruction.
using Four = float[4];

/// λ = constant + ex·by_x + ey·by_y at (ex, ey) pixels from the first corner.
struct FaceOnScreen {
  double x = 0, y = 0;
  Four by_x = {}, by_y = {}, weight = {};
  bool holds = false;
};

HWY_INLINE void Project(const BufferRow& row, int face, FaceOnScreen* f) {
  const int32_t* const corners = row.faces + 3 * static_cast<int64_t>(face);
  const ProjectedVertex &a = row.vertices[corners[0]], &b = row.vertices[corners[1]], &c = row.vertices[corners[2]];
  f->x = a.x_px, f->y = a.y_px;
  const auto ux = static_cast<float>(b.x_px - a.x_px), uy = static_cast<float>(b.y_px - a.y_px);
  const auto vx = static_cast<float>(c.x_px - a.x_px), vy = static_cast<float>(c.y_px - a.y_px);
  const float area = ux * vy - uy * vx, size = (ux * ux + uy * uy) + (vx * vx + vy * vy);
  f->holds = !std::isnan(a.nearness + b.nearness + c.nearness) && std::abs(area) > 1e-6F * size;
  const float per_area = f->holds ? 1 / area : 0;
  f->by_x[0] = (uy - vy) * per_area, f->by_x[1] = vy * per_area, f->by_x[2] = -uy * per_area, f->by_x[3] = 0;
  f->by_y[0] = (vx - ux) * per_area, f->by_y[1] = -vx * per_area, f->by_y[2] = ux * per_area, f->by_y[3] = 0;
  f->weight[0] = row.is_weak ? 1 : static_cast<float>(a.nearness);
  f->weight[1] = row.is_weak ? 1 : static_cast<float>(b.nearness);
  f->weight[2] = row.is_weak ? 1 : static_cast<float>(c.nearness);
  f->weight[3] = 0;
}

int FindPoints(const BufferRow& row, int32_t* HWY_RESTRICT column, int32_t* HWY_RESTRICT face,
               Barycentrics* HWY_RESTRICT barycentrics) {
  constexpr Four constant = {1, 0, 0, 0};
  int count = 0, last = -1;
  FaceOnScreen f;
  for (int i = row.begin; i < row.end; ++i) {
    const int id = row.ids[i];
    if (id < 0) {
      while (i + 8 < row.end && SeeNothing(row.ids + i + 1)) i += 8;
      continue;
    }
    if (id != last) Project(row, last = id, &f);
    column[count] = i;
    face[count] = id;
    const auto ex = static_cast<float>(row.x_px + i - f.x), ey = static_cast<float>(row.y_px - f.y);
    Four lambda, weighted;
    for (int k = 0; k < 4; ++k) lambda[k] = constant[k] + (ex * f.by_x[k] + ey * f.by_y[k]);
    for (int k = 0; k < 4; ++k) weighted[k] = (lambda[k] > 0 ? lambda[k] : 0) * f.weight[k];
    const float sum = (weighted[0] + weighted[2]) + weighted[1];
    const bool holds = f.holds & (lambda[0] > -0.5F) & (lambda[1] > -0.5F) & (lambda[2] > -0.5F);
    const float scale = 1 / sum;
    for (int k = 0; k < 3; ++k) barycentrics[count][k] = weighted[k] * scale;
    barycentrics[count][3] = holds ? 1 : 0;
    ++count;
  }
  return count;
}

}  // namespace bodyloom::resolve_internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bodyloom::resolve_internal {

HWY_EXPORT(FindPoints);

int FindPoints(const BufferRow& row, int32_t* column, int32_t* face, Barycentrics* barycentrics) {
  return HWY_DYNAMIC_DISPATCH(FindPoints)(row, column, face, barycentrics);
}

}  // namespace bodyloom::resolve_internal
#endif  // HWY_ONCE
