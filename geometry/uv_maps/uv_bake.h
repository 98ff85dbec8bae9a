// SPDX-License-Identifier: Apache-2.0
/// Per-vertex values into UV maps: each texel of a UvTexelTable is the weighted mean of its face's three vertices.
/// Planar maps (one H×W plane a channel, float). Texels that show no surface are not written, so planes zeroed once can
/// be reused for any number of frames.
///
/// Only texels that show the surface are touched; cost: docs/lab/descriptors.md. Bitwise reproducible, except that
/// instruction sets differ in the last bits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/uv_maps/uv_texels.h"

namespace bodyloom {

namespace uv_bake_internal {
struct Block;
}

/// Arranges channels in groups of four for the baker: group g of vertex v is at [4 (g V + v)], channel 4g + c its entry
/// c; a last group that is not full is padded with zeros. `values` is V×C, vertex-major.
std::vector<float> InterleaveChannels(std::span<const float> values, int num_vertices, int num_channels);

class UvBaker {
 public:
  /// Keeps no reference to the arguments. Throws std::invalid_argument when a table's face is not one of `faces`.
  UvBaker(const UvTexelTable& table, const MatrixX3i& faces);
  ~UvBaker();
  UvBaker(const UvBaker&);
  UvBaker(UvBaker&&) noexcept;
  UvBaker& operator=(const UvBaker&);
  UvBaker& operator=(UvBaker&&) noexcept;

  [[nodiscard]] int num_pixels() const { return num_pixels_; }

  /// Writes C planes of num_pixels() from grouped channels (InterleaveChannels) one after the other to `maps`. Throws
  /// std::invalid_argument when sizes do not fit.
  void Bake(std::span<const float> grouped, int num_vertices, int num_channels, std::span<float> maps) const;

  /// Writes three planes of unit vectors from vectors at the vertices (V×4, the fourth ignored): the interpolated
  /// vector scaled to length 1 or, where the corners' vectors cancel out, the non-zero one with the largest weight.
  /// Returns the number of texels whose corners cancel out, those without a non-zero vector (0) included.
  int BakeUnit(std::span<const float> vectors, std::span<float> maps) const;

 private:
  void Check(size_t attributes, int num_vertices, size_t maps, int num_channels) const;

  int num_pixels_ = 0, num_vertices_ = 0, num_blank_ = 0;  ///< blank: texels of blocks that show no surface
  std::vector<uv_bake_internal::Block> blocks_;
};

}  // namespace bodyloom
