// SPDX-License-Identifier: Apache-2.0
/// Implements SurfaceTools of pipelines/body/check_body.h with CGAL, for `bodyloom body info --check`.
#pragma once

#include <array>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

/// Pairs of intersecting faces, smaller index first, in ascending order. Faces that share vertices count if they
/// intersect anywhere else. Uses CGAL's exact predicates. No face may name a vertex twice. At non-manifold edges and
/// vertices the mesh is first cut apart, and faces that only touch there count too.
std::vector<std::array<int, 2>> CrossingFaces(const MatrixX3d& vertices, const MatrixX3i& faces);

/// Triangles (N×3 vertices) that close the boundary loops of at most `max_edges` edges, with the orientation of the
/// adjacent faces and small dihedral angles and area (Liepa, "Filling holes in meshes", 2003; CGAL's
/// triangulate_hole()). A loop is left open if two of its vertices coincide (a seam), if closing it takes more than
/// three quarters of the component's area (a sheet), or if every triangulation repeats an edge of the mesh. Empty when
/// the mesh is not an oriented manifold. No face may name a vertex twice.
MatrixX3i HoleFaces(const MatrixX3d& vertices, const MatrixX3i& faces, int max_edges);

}  // namespace bodyloom
