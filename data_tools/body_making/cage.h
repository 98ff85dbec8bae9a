// SPDX-License-Identifier: Apache-2.0
/// The control cage of the built-in body: a closed, mirror-symmetric quad mesh with named vertices, parsed from the
/// text of its left half (assets/body/cage_left_half.txt; layout in assets/body/RECIPE.md, section 3).
///
/// Text format, one item per line, '#' starts a comment:
///   v NAME X Y Z          metres, body frame (x = body's left, y up, z front), X ≥ 0; X = 0 lies on the mirror plane
///   f CHART N1 N2 N3 N4   counter-clockwise seen from outside; CHART is one UV chart name for the whole quad or four
///                         names joined by '|', one for each of the quad's first subdivision children
/// The right half is the mirror image: x → −x, names get a ' appended, quad order reversed; vertices on the plane are
/// shared. Vertices: left half in file order, then the mirrored ones in that order. Quads: left, then right, in file
/// order.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

// Quad connectivity shared by the control cage and its subdivisions.

using Quad = std::array<int, 4>;  ///< vertex indices, counter-clockwise seen from outside
using Edge = std::array<int, 2>;  ///< vertex indices in the direction in which the edge was first met

struct Cage {
  std::vector<std::string> vertex_names;                 ///< N
  MatrixX3d vertices;                                    ///< N×3 metres
  std::vector<Quad> quads;                               ///< Q, left half first
  std::vector<std::array<std::string, 4>> child_charts;  ///< Q: chart of the child at each corner
  std::vector<int> mirror;                               ///< N: index of the mirror image, itself on the plane
  int num_left_vertices = 0;                             ///< vertices [0, num_left_vertices) have x ≥ 0
  int num_left_quads = 0;                                ///< quads [0, num_left_quads) lie in x ≥ 0
};

/// Parses the text. `where` names the file in messages. Throws std::runtime_error with `where`, line, what was found
/// and what was expected: unknown keyword, wrong number of fields, duplicate or unknown vertex, coordinates that are
/// not finite numbers or exceed 100 m, x < 0, more than 100,000 vertices, a mesh that is not closed and manifold.
Cage ParseCage(const std::string& text, const std::string& where);

/// The whole cage's displacements from those of its left half (rows 0..num_left_vertices−1, columns in groups of three,
/// x y z): mirrored rows with x negated.
Eigen::MatrixXd MirrorCageRows(const Cage& cage, const Eigen::MatrixXd& left_rows);

}  // namespace bodyloom
