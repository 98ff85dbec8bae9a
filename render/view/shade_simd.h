// SPDX-License-Identifier: Apache-2.0
/// The inner loops of render/view/shaded_mesh.h, by rows of pixels: plain arrays in, plain arrays out, compiled once
/// per instruction set (see render/raster/raster_simd.h, whose choice at run time they share). The same bits from all
/// of them.
#pragma once

#include <cstdint>

namespace bodyloom::shade_internal {

/// Rows of floats that kernels read or write may be touched up to this many entries beyond their end.
inline constexpr int kLanes = 16;

/// Nearness of `count` samples of a row and of their eight neighbours; see ContourFinder.
struct ContourRow {
  const float* here = nullptr;
  const float* neighbours[8] = {};
  int count = 0;
};

/// mask = −1 where a neighbour is further away than the sample by more than step_m (metres), 0 elsewhere. Nearness is
/// 1/z, or −z when `linear`. Touches nothing beyond `count`.
void FindContour(const ContourRow& row, float step_m, bool linear, int8_t* mask);

/// Normals of any length and full colours (0…255) of `count` pixels in; lit colours in their place.
struct ShadedRow {
  float *nx = nullptr, *ny = nullptr, *nz = nullptr;
  float *blue = nullptr, *green = nullptr, *red = nullptr;
  int count = 0;
};
void ShadePixels(const ShadedRow& row);

/// p = p·(1 − cover) + colour, rounded, for `count` pixels of three bytes; colours come multiplied by their cover.
struct BlendedRow {
  const float *cover = nullptr, *blue = nullptr, *green = nullptr, *red = nullptr;
  int count = 0;
};
void BlendPixels(const BlendedRow& row, uint8_t* bgr);

}  // namespace bodyloom::shade_internal
