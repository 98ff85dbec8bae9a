// SPDX-License-Identifier: Apache-2.0
/// The islands of a UV map and the seams between them, found from the indices: never by the position of the UVs alone,
/// so charts that touch or overlap stay apart.
#pragma once

#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/mesh/mesh_adjacency.h"

namespace bodyloom {

struct UvCharts {
  int num_charts = 0;
  std::vector<int> chart;  ///< F: 0..num_charts−1, numbered by their lowest face
  /// 3F, by half-edge (geometry/mesh/mesh_adjacency.h): the UVs across the edge are others, or there is no face across
  std::vector<char> is_seam;
  MeshAdjacency mesh;  ///< of the position indices
};

/// UV vertices that coincide and lie on one position vertex count as one, so files that repeat a UV for every face do
/// not fall to pieces. Throws std::invalid_argument when the body has no UV or a UV is not finite.
UvCharts FindUvCharts(const BodyModel& body);

}  // namespace bodyloom
