// SPDX-License-Identifier: Apache-2.0
/// Repairs faults of a body's mesh (geometry/mesh/mesh_check.h). Except for filled holes the body's surface and motion
/// do not change.
///
///   turned faces          get their corners the other way round, with their UV corners
///   superfluous faces     (a corner twice, or the vertices of an earlier face) go; the others keep their parts and UV
///   vertices at one place become the first of them, where they also move as one: shape, correctives and skinning
///                         weights equal to within the tolerance; their shares in joints and landmarks are added up
///   unreferenced vertices go, unless joints or landmarks are computed from them
///   holes                 get faces between their vertices, where the caller brings what triangulates them; the new
///                         faces come last, with parts and UV of the faces beside them
///
/// Not repaired, because that requires a decision about the shape: edges of more than two faces, pinched vertices, flat
/// faces (removing them would leave a hole), several components, self-intersections.
///
/// Vertices keep their numbers where other data refer to them: on a body of SMPL's or SMPL-X's topology (6,890 or
/// 10,475 vertices; UV files, DensePose's table and detectors' keypoints name its vertices) none is merged or dropped.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"

namespace bodyloom {

/// Triangles (N×3 vertices, oriented as the faces beside them) that close the boundary loops of at most `max_edges`
/// edges; no row for a loop that cannot be closed without a fault. `faces` contains no face with a repeated vertex and
/// no two faces with the same vertices.
using FindHoleFaces = std::function<MatrixX3i(const MatrixX3d& vertices, const MatrixX3i& faces, int max_edges)>;

struct RepairBodyOptions {
  double same_place_m = 0;   ///< as CheckMeshOptions::same_place_m; also the tolerance of "move as one", at least 1e-5
  FindHoleFaces hole_faces;  ///< empty: holes stay
  int max_hole_edges = 100;  ///< a hole of more edges stays: it may be intended, like the rim of a garment
};

struct RepairBodySummary {
  int turned_faces = 0, dropped_faces = 0;
  int merged_vertices = 0, dropped_vertices = 0;
  int filled_holes = 0, added_faces = 0;
  /// Vertices kept although they coincide or lie in no face: they move differently, joints or landmarks need them, or
  /// other data refer to their numbers.
  int vertices_that_part = 0, vertices_in_use = 0, vertices_numbered_elsewhere = 0;
  double largest_merge_m = 0;  ///< distance of merged vertices in the template

  [[nodiscard]] bool changed() const {
    return turned_faces + dropped_faces + merged_vertices + dropped_vertices + added_faces > 0;
  }
  /// True if vertex or face numbers have changed.
  [[nodiscard]] bool renumbered_vertices() const { return merged_vertices + dropped_vertices > 0; }
};

/// Repairs `body`, which must satisfy BodyModel (std::invalid_argument otherwise, and when `hole_faces` returns faces
/// that AppendFaces rejects).
RepairBodySummary RepairBody(const RepairBodyOptions& options, BodyModelData* body);

}  // namespace bodyloom
