// SPDX-License-Identifier: Apache-2.0
/// The inner loops of geometry/uv_maps/uv_bake.h: plain arrays, no Eigen, compiled once per instruction set and chosen
/// at run time (as geometry/body/skinning_simd.h; ForceSimdTarget there applies here too).
///
/// Texels come in blocks of four neighbours in memory, attributes in groups of four channels (V×4), so that a block of
/// a group is twelve loads, twelve multiply-adds, one 4×4 transpose in registers and four stores. One group at a time:
/// its vertices (126 kB for 7,874) and its four planes stay in the cache, which 33 planes a power of two apart would
/// not.
#pragma once

#include <cstdint>

namespace bodyloom::uv_bake_internal {

/// Four texels from `pixel` on, a multiple of four; texels that show no surface have zero weights.
struct Block {
  int32_t pixel;
  int32_t vertex[4][3];
  float weight[4][3];
};

/// planes[c][pixel] = Σ weight · attributes[4 vertex + c] for c < num_planes (1 to 4); texels outside all blocks are
/// not written. Of a block that extends beyond num_pixels, only the texels before it are stored.
void BakeGroup(const Block* blocks, int num_blocks, int num_pixels, const float* attributes, int num_planes,
               float* const* planes);

/// Two full groups (eight planes) at once, the second group_stride values behind the first: indices and weights are
/// read once for both. Same results as BakeGroup.
void BakeTwoGroups(const Block* blocks, int num_blocks, int num_pixels, const float* attributes, int64_t group_stride,
                   float* const* planes);

/// As BakeGroup, of a vector (three planes), scaled to length 1; 0 where its length is below 1e-6. Returns the number
/// of texels, empty ones included, that became 0.
int BakeUnitVectors(const Block* blocks, int num_blocks, int num_pixels, const float* attributes, float* const* planes);

/// IEEE half precision, rounded to nearest even, beyond ±65504 to infinity.
void HalfFromFloat(const float* values, int64_t count, uint16_t* halves);

}  // namespace bodyloom::uv_bake_internal
