// SPDX-License-Identifier: Apache-2.0
/// A body as programs for animation take it: one index a corner, four joints a vertex, few shapes for its pose
/// correctives; and how far that is from the body itself.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "data_tools/export/export_scene.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

constexpr int kSkinInfluences = 4;

struct SkinnedMesh {
  MatrixX3d positions;           ///< N×3 T-pose of the shape, body frame; vertices of UV seams are there twice
  MatrixX3f normals;             ///< N×3 unit, of the T-pose
  MatrixX2f uv;                  ///< N×2, v up; no rows when the body has no UV map
  MatrixX3i faces;               ///< F×3
  std::vector<int> body_vertex;  ///< N: of the body
  std::vector<std::array<int, kSkinInfluences>> joints;     ///< N; unused ones are 0
  std::vector<std::array<float, kSkinInfluences>> weights;  ///< N; of each sum 1, falling
  int reduced_vertices = 0;  ///< that had more joints; the lightest were left out and the rest scaled to sum 1
  /// Displacements (N×3) that weights in [0, 1] scale and add to `positions` before skinning, and these weights: frames
  /// of the person × shapes.
  std::vector<MatrixX3f> shapes;
  RowMatrixXd shape_weights;
  /// Distance of its posed vertices to those of the body, over up to 64 of the person's frames.
  double rms_error_m = 0, max_error_m = 0;
};

/// `num_shapes`: at most so many for the pose correctives, 0 to 64. They are the leading principal components of the
/// correctives over the person's frames (256 at most), their mean folded into `positions`; 8 is what programs are asked
/// to support. Throws std::invalid_argument for other numbers.
SkinnedMesh MakeSkinnedMesh(const ExportPerson& person, int num_shapes = 8);

}  // namespace bodyloom
