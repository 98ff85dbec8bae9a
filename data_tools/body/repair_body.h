// SPDX-License-Identifier: Apache-2.0
/// Mends what can be mended of a body's mesh (geometry/mesh/mesh_check.h) without changing how the body looks or moves.
///
///   turned faces          get their corners the other way round, with their UV corners
///   superfluous faces     (a corner twice, or the vertices of an earlier face) go; the others keep their parts and UV
///   vertices at one place become the first of them, where they also move as one: shape, correctives and skinning
///                         weights equal to within the tolerance; their shares in joints and landmarks are added up
///   unreferenced vertices go, unless joints or landmarks are computed from them
///
/// Not mended, because it takes a decision about the shape: holes, edges of more than two faces, pinched vertices, flat
/// faces (without them there would be a hole), several components, surfaces that cross themselves.
///
/// Vertices keep their numbers wherever other data go by them: on a body of SMPL's or SMPL-X's topology (6,890 or
/// 10,475 vertices; UV files, DensePose's table and detectors' keypoints name its vertices) none is merged or dropped.
#pragma once

#include <string>
#include <vector>

#include "geometry/body/body_model.h"

namespace bodyloom {

struct RepairBodyOptions {
  double same_place_m = 0;  ///< as CheckMeshOptions::same_place_m; also the tolerance of "move as one", at least 1e-5
};

struct RepairBodySummary {
  int turned_faces = 0, dropped_faces = 0;
  int merged_vertices = 0, dropped_vertices = 0;
  /// Vertices left although they lie at one place or in no face: they move differently, joints or landmarks need them,
  /// or their numbers are other data's.
  int vertices_that_part = 0, vertices_in_use = 0, vertices_numbered_elsewhere = 0;
  double largest_merge_m = 0;  ///< distance of merged vertices in the template

  [[nodiscard]] bool changed() const { return turned_faces + dropped_faces + merged_vertices + dropped_vertices > 0; }
  /// Vertex or face numbers are not what they were.
  [[nodiscard]] bool renumbered_vertices() const { return merged_vertices + dropped_vertices > 0; }
};

/// Mends `body`, which must satisfy BodyModel (std::invalid_argument otherwise).
RepairBodySummary RepairBody(const RepairBodyOptions& options, BodyModelData* body);

}  // namespace bodyloom
