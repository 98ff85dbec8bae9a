// SPDX-License-Identifier: Apache-2.0
/// The inner loop of render/raster/resolve_pixels.h: barycentrics of the covered pixels of a row. Plain arrays in,
/// plain arrays out, compiled once per instruction set like render/raster/raster_simd.h. The same bits from all of
/// them.
#pragma once

#include <array>
#include <cstdint>

#include "render/raster/raster_simd.h"

namespace bodyloom::resolve_internal {

/// Columns begin..end−1 of a row of a visibility buffer without lens distortion.
struct BufferRow {
  const int32_t* ids = nullptr;  ///< face per column, −1: none
  int begin = 0, end = 0;
  int x_px = 0, y_px = 0;          ///< pixel of column 0
  const int32_t* faces = nullptr;  ///< F×3
  const ProjectedVertex* vertices = nullptr;
  bool is_weak = false;  ///< weak perspective: barycentrics are linear on the screen
};

/// Three barycentrics, and 1 if they are valid; 0 if the face is seen edge-on, has unprojectable corners, or lies too
/// far from the pixel for float.
using Barycentrics = std::array<float, 4>;

/// Writes the covered pixels to arrays of capacity end − begin. Returns their number.
int FindPoints(const BufferRow& row, int32_t* column, int32_t* face, Barycentrics* barycentrics);

}  // namespace bodyloom::resolve_internal
