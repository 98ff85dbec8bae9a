// SPDX-License-Identifier: Apache-2.0
/// Mesh adjacency: which faces meet at a vertex and which lie across an edge, from position indices: a seam of the UV
/// map is no boundary here.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

/// Edge k of a face runs from corner k to corner (k + 1) mod 3. A half-edge is 3·face + k.
struct MeshAdjacency {
  std::vector<int>
      corner_begin;         ///< V+1: corners at vertex v are corner[corner_begin[v]] … corner[corner_begin[v+1]−1]
  std::vector<int> corner;  ///< 3·face + corner, ascending at each vertex

  /// Of each half-edge the one across it, that is, of the other face at the same two vertices, whichever way it runs;
  /// −1 at the boundary of the mesh and where more than two faces meet.
  std::vector<int> opposite;
  int num_boundary_edges = 0;      ///< edges with one face
  int num_non_manifold_edges = 0;  ///< edges with more than two
};

/// O(F log F). Throws std::invalid_argument on an index outside 0..num_vertices−1.
MeshAdjacency BuildMeshAdjacency(const MatrixX3i& faces, int num_vertices);

}  // namespace bodyloom
