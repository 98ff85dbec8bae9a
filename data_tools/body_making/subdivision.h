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
#include "data_tools/body_making/left_half_arrays.h"
#include "geometry/body/body_model.h"
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

// The cage of the built-in body (cage.h) after its two Catmull–Clark levels: connectivity, symmetry, and the operators
// from cage to vertices.

inline constexpr int kQuadsPerCageQuad = 16;  ///< quad i lies in cage quad i / 16

struct RefinedCage {
  std::vector<Quad> quads;
  std::vector<int> mirror;         ///< V: index of the mirror image, itself on the plane
  SparseRows fine_from_cage;       ///< V×N: S2 S1 of the subdivision
  SparseRows bilinear_from_cage;   ///< V×N: the same vertices by halving edges and quads, for values given at the cage
  std::vector<int> left_vertices;  ///< of quads of the left half, increasing
  int num_left_quads = 0;
};

/// Throws std::invalid_argument when the cage cannot be subdivided or is not symmetric.
RefinedCage RefineCage(const Cage& cage);

/// Sets the skinning weights of both halves from those of the left vertices, in the order of `left_vertices`;
/// `joint_mirror` has an entry for each of the body's joints.
void FillWeights(const RefinedCage& refined, const std::vector<int>& joint_mirror,
                 const std::vector<WeightedIndices>& left_weights, BodyModelData* body);

}  // namespace bodyloom
