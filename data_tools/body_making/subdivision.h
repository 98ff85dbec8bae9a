// SPDX-License-Identifier: Apache-2.0
/// Catmull–Clark subdivision of a closed quad mesh as a linear operator, in a fixed index order.
///
/// One level on (V vertices, F quads, E edges):
///   vertices  [old vertices, moved] [face points, in quad order] [edge points, in the order in which the edges 01, 12,
///             23, 30 of quads 0, 1, 2 … are first met]
///   face point  = mean of the quad's corners
///   edge point  = (a + b + F1 + F2) / 4 with the two adjacent face points
///   old vertex of valence n = (mean of its n face points + 2 · mean of its n edge midpoints + (n − 3) v) / n
///   quads     (a,b,c,d) → (a,e_ab,F,e_da), (b,e_bc,F,e_ab), (c,e_cd,F,e_bc), (d,e_da,F,e_cd): child k keeps corner k
/// so fine quad i descends from coarse quad i/4 and coarse vertex i is still vertex i.
/// Source: Catmull and Clark, "Recursively generated B-spline surfaces on arbitrary topological meshes", 1978.
#pragma once

#include <vector>

#include "data_tools/body_making/cage.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

struct SubdivisionLevel {
  std::vector<Quad> quads;      ///< 4F
  std::vector<Edge> edges;      ///< E coarse edges; edge e gives fine vertex V + F + e
  SparseRows fine_from_coarse;  ///< (V+F+E)×V, rows sum to 1
};

/// Throws std::invalid_argument unless every edge has a quad on each side and every index is below num_vertices.
SubdivisionLevel SubdivideCatmullClark(int num_vertices, const std::vector<Quad>& quads);

/// The mirror image of each fine vertex, given that of each coarse vertex (an involution that maps quads to quads).
/// Throws std::invalid_argument when the connectivity is not symmetric under it.
std::vector<int> MirrorOfSubdivision(const std::vector<int>& coarse_mirror, const std::vector<Quad>& coarse_quads,
                                     const SubdivisionLevel& level);

/// Two triangles per quad: (0,1,2) and (0,2,3).
MatrixX3i TrianglesOfQuads(const std::vector<Quad>& quads);

}  // namespace bodyloom
