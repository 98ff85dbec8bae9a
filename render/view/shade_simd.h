// SPDX-License-Identifier: Apache-2.0
/// The inner loops of render/view/shaded_mesh.h, by rows of pixels: plain arrays in, plain arrays out, compiled once
/// per instruction set and selected at run time with render/raster/raster_simd.h. The same bits from all of them.
#pragma once

#include <cstdint>

namespace bodyloom::shade_internal {

/// Kernels may access up to this many entries beyond the end of rows of floats.
inline constexpr int kLanes = 16;

/// Nearness of `count` samples of a row and of their eight neighbours; see ContourFinder.
struct ContourRow {
  const float* here = nullptr;
  const float* neighbours[8] = {};
  int count = 0;
};

/// mask = −1 where a neighbour is further away than the sample by more than step_m (metres), 0 elsewhere. Nearness is
/// 1/z, or −z when `linear`. Accesses nothing beyond `count`.
void FindContour(const ContourRow& row, float step_m, bool linear, int8_t* mask);

/// Normals of any length and unlit colours (0…255) of `count` pixels; shading is done in place.
struct ShadedRow {
  float *nx = nullptr, *ny = nullptr, *nz = nullptr;
  float *blue = nullptr, *green = nullptr, *red = nullptr;
  int count = 0;
};
void ShadePixels(const ShadedRow& row);

/// Blending p = p·(1 − cover) + colour, rounded, of `count` pixels of three bytes; colours are premultiplied by cover.
struct BlendedRow {
  const float *cover = nullptr, *blue = nullptr, *green = nullptr, *red = nullptr;
  int count = 0;
};
void BlendPixels(const BlendedRow& row, uint8_t* bgr);

}  // namespace bodyloom::shade_internal
