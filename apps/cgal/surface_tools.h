// SPDX-License-Identifier: Apache-2.0
/// What `bodyloom body info --check` has CGAL do: pipelines/body/check_body.h, SurfaceTools.
#pragma once

#include <array>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

/// Pairs of faces that cross each other, the smaller number first, in ascending order. Faces that share vertices count
/// where they meet anywhere else. By CGAL's exact predicates. No face may name a vertex twice. Where more than two
/// faces meet in an edge, or fans in a vertex, the mesh is first cut apart there, and faces that only touch count too.
std::vector<std::array<int, 2>> CrossingFaces(const MatrixX3d& vertices, const MatrixX3i& faces);

/// Triangles (N×3 vertices) that close the boundary loops of at most `max_edges` edges, running as the faces beside
/// them: those of small dihedral angles and area (Liepa, "Filling holes in meshes", 2003; CGAL's triangulate_hole()). A
/// loop is left open where two of its vertices lie at one place (a seam, which has nothing to close), where closing it
/// takes more than three quarters of the component's area (a sheet, which would get a second side), or where every
/// triangulation repeats an edge of the mesh. No row when the mesh is no oriented manifold. No face may name a vertex
/// twice.
MatrixX3i HoleFaces(const MatrixX3d& vertices, const MatrixX3i& faces, int max_edges);

}  // namespace bodyloom
