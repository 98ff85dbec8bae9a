// SPDX-License-Identifier: Apache-2.0
/// Mesh adjacency: the faces that meet at a vertex and those on either side of an edge, by position indices, so a seam
/// of the UV map is not a boundary.
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

  /// The opposite of each half-edge: that of the other face with the same two vertices, in either direction; −1 at the
  /// boundary of the mesh and where more than two faces meet.
  std::vector<int> opposite;
  int num_boundary_edges = 0;      ///< edges with one face
  int num_non_manifold_edges = 0;  ///< edges with more than two
};

/// O(F log F). Throws std::invalid_argument on an index outside 0..num_vertices−1.
MeshAdjacency BuildMeshAdjacency(const MatrixX3i& faces, int num_vertices);

}  // namespace bodyloom
