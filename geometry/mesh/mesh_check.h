// SPDX-License-Identifier: Apache-2.0
/// Checks whether a triangle mesh is the closed, outward-oriented surface of a solid, and lists its faults.
///
/// Any mesh may be checked, including one that a half-edge structure cannot represent. Faces with a repeated corner and
/// faces with the three vertices of an earlier one are listed and then left out, so that one doubled face is not
/// reported as three edges of three faces as well.
///
///   edge       boundary: one face; regular: two; non-manifold: more
///   vertex     non-manifold: its faces, joined across their edges, make more than one fan
///   component  faces joined across regular edges. Closed: no other edge. Orientable: its faces can be turned so that
///              the two faces of every regular edge run through it in opposite directions
///   volume     of an orientable component with its faces so turned: Σ det(a, b, c) / 6, boundary loops closed by fans
///              about their mean; outward where positive
///
/// An orientable component should have a positive volume. Where |volume| < 10⁻³ area^1.5 (a sheet; a sphere has 0.094)
/// the outside is not defined, and the orientation of the majority of faces is taken as correct. A component inside
/// another is checked like any other: an eyeball is a solid, not a cavity.
#pragma once

#include <array>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

struct CheckMeshOptions {
  double same_place_m = 0;      ///< vertices this close or closer coincide; 0: only those with equal coordinates
  double flat_height_m = 1e-7;  ///< a face whose smallest height is not above this is flat
};

struct MeshComponent {
  int num_faces = 0;
  bool is_closed = false, is_orientable = false;
  int turned_faces = 0;  ///< number of its faces with the wrong orientation
  double volume_m3 = 0;  ///< after they are turned; 0 where the outside is not defined
};

struct CheckMeshResult {
  std::vector<int> repeated_corner_faces;  ///< faces that name a vertex twice
  std::vector<int> flat_faces;             ///< faces with three vertices but no area
  std::vector<int> duplicate_faces;        ///< faces with the vertices of an earlier face, in either orientation
  std::vector<int> unreferenced_vertices;  ///< vertices in no face
  /// Vertex and the first vertex at the same position.
  std::vector<std::array<int, 2>> duplicate_vertices;
  std::vector<std::array<int, 2>> non_manifold_edges;  ///< their vertices
  std::vector<int> non_manifold_vertices;
  int boundary_edges = 0;
  std::vector<std::vector<int>> boundary_loops;  ///< vertices along each
  int inconsistent_edges = 0;                    ///< regular edges that both faces traverse in the same direction
  std::vector<int> turned_faces;                 ///< wrongly oriented faces of orientable components, ascending
  std::vector<MeshComponent> components;         ///< by descending number of faces

  /// True if the mesh is one closed component facing outwards, without any of the faults above.
  [[nodiscard]] bool IsClean() const;
};

/// O(F log F). Metres. Throws std::invalid_argument on an index outside the vertices, a tolerance that is negative or
/// not finite, or a vertex that is not finite.
CheckMeshResult CheckMesh(const MatrixX3d& vertices, const MatrixX3i& faces, const CheckMeshOptions& options = {});

/// Faces listed as repeated_corner_faces or duplicate_faces, ascending.
std::vector<int> SuperfluousFaces(const CheckMeshResult& result);

}  // namespace bodyloom
