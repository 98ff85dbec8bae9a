// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

/// Pairs of faces that cross each other, the smaller number first, in ascending order. Faces that share vertices count
/// where they meet anywhere else. By CGAL's exact predicates. No face may name a vertex twice. Where more than two
/// faces meet in an edge, or fans in a vertex, the mesh is first cut apart there, and faces that only touch count too.
std::vector<std::array<int, 2>> CrossingFaces(const MatrixX3d& vertices, const MatrixX3i& faces);

}  // namespace bodyloom
