// SPDX-License-Identifier: Apache-2.0
/// The texels of a UV map as a graph of the surface: neighbours in the map, and across seams the texel that lies on the
/// other side, found through the gutter (geometry/uv_texels.h). What spreads along it knows no charts.
#pragma once

#include <vector>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/uv_texels.h"

namespace bodyloom {

struct UvGraph {
  std::vector<int> pixel;      ///< pixel of each node: the texels inside a chart, in the order of rows
  std::vector<int> begin;      ///< nodes + 1
  std::vector<int> neighbour;  ///< nodes, ascending at each
  int num_seam_links = 0;      ///< edges that cross a seam
  [[nodiscard]] int num_nodes() const { return static_cast<int>(pixel.size()); }
};

/// The table must have a gutter (at least 1), else no seam is crossed.
UvGraph BuildUvGraph(const BodyModel& body, const UvTexelTable& table);

}  // namespace bodyloom
