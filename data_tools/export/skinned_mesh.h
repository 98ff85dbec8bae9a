// SPDX-License-Identifier: Apache-2.0
/// A skinned mesh of a body for animation programs: one index per corner, four joints per vertex, few shapes for its
/// pose correctives; and its error against the body.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "data_tools/export/export_scene.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

constexpr int kSkinInfluences = 4;
constexpr int kMaxShapes = 64;

struct SkinnedMesh {
  MatrixX3d positions;           ///< N×3 T-pose of the shape, body frame; vertices of UV seams are duplicated
  MatrixX3f normals;             ///< N×3 unit, of the T-pose
  MatrixX2f uv;                  ///< N×2, v up; no rows when the body has no UV map
  MatrixX3i faces;               ///< F×3
  std::vector<int> body_vertex;  ///< N: index of the body's vertex
  std::vector<std::array<int, kSkinInfluences>> joints;     ///< N; unused ones are 0
  std::vector<std::array<float, kSkinInfluences>> weights;  ///< N; descending, each sums to 1
  int reduced_vertices = 0;  ///< that had more joints; the smallest weights were dropped and the rest rescaled to sum 1
  /// Displacements (N×3) added to `positions` before skinning with weights in [0, 1], and these weights: frames of the
  /// person × shapes.
  std::vector<MatrixX3f> shapes;
  RowMatrixXd shape_weights;
  /// Distance of the posed vertices to those of the body, over up to 64 of the person's frames.
  double rms_error_m = 0, max_error_m = 0;
};

/// `num_shapes`: maximum number of shapes for the pose correctives, 0 to 64. They are the leading principal components
/// of the correctives over the person's frames (at most 256), their mean added to `positions`; programs are asked to
/// support 8. Throws std::invalid_argument for other numbers.
SkinnedMesh MakeSkinnedMesh(const ExportPerson& person, int num_shapes = 8);

/// Up to `maximum` of the frames 0 … n − 1, evenly spread, first and last among them.
std::vector<int> SpreadFrames(int n, int maximum);

/// The skins of a written file.
struct SkinSummary {
  int people = 0;
  double rms_error_m = 0, max_error_m = 0;  ///< of posed vertices to the bodies' own, of all people
  int influences = 0;                       ///< joints per vertex at most; 0: all of the body's
  int reduced_vertices = 0;                 ///< that had more
  int shapes = 0;                           ///< of all people
  size_t bytes = 0;                         ///< of the file

  void AddPerson(double rms_of_person_m, double max_of_person_m, size_t shapes_of_person);
};

}  // namespace bodyloom
