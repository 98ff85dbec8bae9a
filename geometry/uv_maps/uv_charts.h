// SPDX-License-Identifier: Apache-2.0
/// Charts (islands) of a UV map and the seams between them, by the indices and not by UV positions alone, so charts
/// that touch or overlap remain separate.
#pragma once

#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/mesh/mesh_adjacency.h"

namespace bodyloom {

struct UvCharts {
  int num_charts = 0;
  std::vector<int> chart;  ///< F: 0..num_charts−1, numbered by their lowest face
  /// 3F, by half-edge (geometry/mesh/mesh_adjacency.h): the UVs across the edge differ, or there is no face across it
  std::vector<char> is_seam;
  MeshAdjacency mesh;  ///< of the position indices
};

/// UV vertices that coincide and lie on one position vertex count as one, so a file that repeats UVs for every face is
/// not split into single faces. Throws std::invalid_argument when the body has no UV or a UV is not finite.
UvCharts FindUvCharts(const BodyModel& body);

}  // namespace bodyloom
