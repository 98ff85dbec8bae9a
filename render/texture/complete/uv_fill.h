// SPDX-License-Identifier: Apache-2.0
/// Fills the holes of UV maps (unseen texels) smoothly over the surface, across seams: both methods work on the graph
/// of texels (UvGraph), not on the image grid.
///
/// PyramidFill: pull–push. Texels are merged into coarser cells (2×2 of one chart per level); means of known texels
/// propagate back down to unknown ones, smoothed by a few averages with neighbours on every level. Linear in the number
/// of texels; built once per table for any number of maps and masks.
///
/// LaplaceFill: the harmonic solution, Σ_neighbours (x_i − x_j) = 0 at every hole with known texels fixed; the matrix
/// is factored once per mask, each map is a back-substitution.
///
/// Both: known texels keep their values; constants are reproduced; values stay within the range of the known ones;
/// parts of the surface not connected to known texels take the mean of all known ones; a map without known texels is
/// unchanged. The gutter is filled from the surface it shows.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/uv_maps/uv_texels.h"

namespace bodyloom {

// Texels of a UV map as a graph of the surface: neighbours in the map and, found through the gutter
// (geometry/uv_maps/uv_texels.h), across seams.

struct UvGraph {
  std::vector<int> pixel;      ///< pixel of each node: the texels inside a chart, in the order of rows
  std::vector<int> begin;      ///< nodes + 1
  std::vector<int> neighbour;  ///< nodes, ascending at each
  int num_seam_links = 0;      ///< edges across a seam
  [[nodiscard]] int num_nodes() const { return static_cast<int>(pixel.size()); }
};

/// Without a gutter (at least 1) of the table no seam is crossed.
UvGraph BuildUvGraph(const BodyModel& body, const UvTexelTable& table);

class PyramidFill {
 public:
  /// Borrows nothing. Seams are crossed only if the table has a gutter.
  PyramidFill(const BodyModel& body, const UvTexelTable& table);
  ~PyramidFill();

  /// Fills `maps` (num_channels planes) in place; known: one byte per texel, 0: hole. Throws std::invalid_argument when
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

/// Sets each gutter texel to the value of the surface point it shows, from the known texels around that point; without
/// any it stays. Otherwise a gathered map would be dark along its seams.
void FillGutter(const BodyModel& body, const UvTexelTable& table, std::span<const uint8_t> known, int num_channels,
                std::span<float> maps);

}  // namespace bodyloom
