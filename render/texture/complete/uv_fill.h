// SPDX-License-Identifier: Apache-2.0
/// Fills the holes of UV maps (texels that no frame has seen) smoothly over the surface, seams included: both ways
/// below work on the graph of texels (render/texture/complete/uv_fill.h), not on the picture.
///
/// PyramidFill: pull–push. Texels are merged into ever coarser cells (2×2 of one chart a level); each cell's mean of
/// what is known flows back down into what is not, smoothed by a few averages with its neighbours on every level.
/// Linear in the number of texels; made once for a table, any number of maps and masks.
///
/// LaplaceFill: the exact smoothest filling, the solution of Σ_neighbours (x_i − x_j) = 0 at every hole with the known
/// texels held; the matrix is factored once for a mask, each map is a back-substitution.
///
/// Both: known texels keep their values; constants stay constants; values never leave the range of the known ones;
/// parts of the surface that nothing known is connected to take the mean of all known texels; where nothing at all is
/// known, the map is left alone. The gutter is filled from the surface it shows.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/uv_maps/uv_texels.h"

namespace bodyloom {

// The texels of a UV map as a graph of the surface: neighbours in the map, and across seams the texel that lies on the
// other side, found through the gutter (geometry/uv_maps/uv_texels.h). What spreads along it knows no charts.

struct UvGraph {
  std::vector<int> pixel;      ///< pixel of each node: the texels inside a chart, in the order of rows
  std::vector<int> begin;      ///< nodes + 1
  std::vector<int> neighbour;  ///< nodes, ascending at each
  int num_seam_links = 0;      ///< edges that cross a seam
  [[nodiscard]] int num_nodes() const { return static_cast<int>(pixel.size()); }
};

/// The table must have a gutter (at least 1), else no seam is crossed.
UvGraph BuildUvGraph(const BodyModel& body, const UvTexelTable& table);

class PyramidFill {
 public:
  /// Borrows nothing. The table must have a gutter for seams to be crossed.
  PyramidFill(const BodyModel& body, const UvTexelTable& table);
  ~PyramidFill();

  /// Fills `maps` (num_channels planes) in place; known: one byte a texel, 0: hole. Throws std::invalid_argument when
  /// sizes do not fit.
  void Fill(std::span<const uint8_t> known, int num_channels, std::span<float> maps) const;

 private:
  struct Pyramid;
  std::unique_ptr<Pyramid> pyramid_;
};

class LaplaceFill {
 public:
  /// Factors the matrix of the holes of `known`.
  LaplaceFill(const BodyModel& body, const UvTexelTable& table, std::span<const uint8_t> known);
  ~LaplaceFill();

  void Fill(int num_channels, std::span<float> maps) const;

 private:
  struct System;
  std::unique_ptr<System> system_;
};

/// Gives each gutter texel the value of the surface point it shows, from the known texels around that point; where none
/// is known it stays as it is. Without it a map that was gathered texel by texel is dark along its seams.
void FillGutter(const BodyModel& body, const UvTexelTable& table, std::span<const uint8_t> known, int num_channels,
                std::span<float> maps);

}  // namespace bodyloom
