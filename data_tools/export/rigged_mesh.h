// SPDX-License-Identifier: Apache-2.0
/// A body's mesh in the rest pose of an animation rig, skinned there with all of the body's joints and weights.
///
/// A vertex y of a frame, posed by the body with its correctives, is taken back to the rest pose by the inverse of its
/// blended transform: x = (Σ_j w_j M_j)⁻¹ y, where M_j is the motion of joint j from the rig's rest pose. In the T-pose
/// x is the vertex with the frame's correctives. In an A-pose it also holds what linear blending of a body that rests
/// in the T-pose does differently. The mesh is the mean of x over the frames, its shapes the leading principal
/// components. Where joints are turned against each other so far that the blend has no inverse, x is the frame's vertex
/// in the T-pose, blended into the rest pose.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "data_tools/export/export_scene.h"
#include "data_tools/motion/animation_rig.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

struct RiggedMesh {
  MatrixX3d joints;     ///< J×3 of the rest pose, body frame
  MatrixX3d positions;  ///< V×3 of the rest pose, body frame, in the order of the body's vertices
  MatrixX3f normals;    ///< V×3 unit, of these positions
  /// Displacements (V×3) added to `positions` before skinning with weights in [0, 1], and these weights: frames of the
  /// person × shapes.
  std::vector<MatrixX3f> shapes;
  RowMatrixXd shape_weights;
  /// Distance of the posed vertices to those of the body, over up to 64 of the person's frames.
  double rms_error_m = 0, max_error_m = 0;
};

/// `num_shapes`: maximum number of shapes, 0 to 64, learned from at most 256 of the person's frames. Throws
/// std::invalid_argument for other numbers.
RiggedMesh MakeRiggedMesh(const ExportPerson& person, const RigSkeleton& rig, int num_shapes = 8);

}  // namespace bodyloom
