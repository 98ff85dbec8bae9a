// SPDX-License-Identifier: Apache-2.0
/// Faults of a triangle mesh: what keeps it from being the closed, outward surface of a solid.
///
/// Any mesh may be checked, also one that no half-edge structure holds. Faults are told apart: faces with a corner
/// twice, and faces with the three vertices of an earlier one, are listed and then left out, so that one doubled face
/// is not three edges of three faces as well.
///
///   edge       boundary: one face; regular: two; non-manifold: more
///   vertex     non-manifold: its faces, joined across their edges, make more than one fan
///   component  faces joined across regular edges. Closed: no other edge. Orientable: its faces can be turned so that
///              the two faces of every regular edge run through it in opposite directions
///   volume     of an orientable component with its faces so turned: Σ det(a, b, c) / 6, boundary loops closed by fans
///              about their mean; outward where positive
///
/// An orientable component should have a positive volume. Where |volume| < 10⁻³ area^1.5 (a sheet; a sphere has 0.094)
/// there is no outside, and the side that more faces show is right. A component inside another is checked like any
/// other: eyeballs are solids, not hollows.
#pragma once

#include <array>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

struct CheckMeshOptions {
  double same_place_m = 0;      ///< vertices no further apart are one place; 0: equal coordinates alone
  double flat_height_m = 1e-7;  ///< a face whose smallest height is not above this is flat
};

struct MeshComponent {
  int num_faces = 0;
  bool is_closed = false, is_orientable = false;
  int turned_faces = 0;  ///< of these face the wrong way
  double volume_m3 = 0;  ///< after they are turned; 0 where there is no outside
};

struct CheckMeshResult {
  std::vector<int> repeated_corner_faces;  ///< name a vertex twice
  std::vector<int> flat_faces;             ///< have three vertices but no area
  std::vector<int> duplicate_faces;        ///< have the vertices of an earlier face, whichever way round
  std::vector<int> unreferenced_vertices;  ///< in no face
  /// Vertex and the first vertex at its place.
  std::vector<std::array<int, 2>> duplicate_vertices;
  std::vector<std::array<int, 2>> non_manifold_edges;  ///< their vertices
  std::vector<int> non_manifold_vertices;
  int boundary_edges = 0;
  std::vector<std::vector<int>> boundary_loops;  ///< vertices along each
  int inconsistent_edges = 0;                    ///< regular ones whose two faces run through them the same way
  std::vector<int> turned_faces;                 ///< face the wrong way, ascending; of orientable components
  std::vector<MeshComponent> components;         ///< the most faces first

  /// Nothing above but one closed component that faces outwards.
  [[nodiscard]] bool IsClean() const;
};

/// O(F log F). Metres. Throws std::invalid_argument on an index outside the vertices, a tolerance that is negative or
/// not finite, or a vertex that is not finite.
CheckMeshResult CheckMesh(const MatrixX3d& vertices, const MatrixX3i& faces, const CheckMeshOptions& options = {});

/// Twice in one: faces that CheckMesh lists as repeated_corner_faces or duplicate_faces, ascending.
std::vector<int> SuperfluousFaces(const CheckMeshResult& result);

}  // namespace bodyloom
