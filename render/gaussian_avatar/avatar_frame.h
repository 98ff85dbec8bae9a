// SPDX-License-Identifier: Apache-2.0
/// A frame as input for posing a person's Gaussians: bones and pose correctives of the skin.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/cloth/loose_garment.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"

namespace bodyloom {

/// Bones and correctives in the coordinate frame of the posed Gaussians, usually the camera's.
struct AvatarFrame {
  /// J × 12, followed by 12 per node of a garment (render/gaussian_avatar/cloth_bones.h): rows of [R_k | t_k], t_k =
  /// p_k − R_k j_k: bone k maps a point x_c of rest space to R_k (x_c − j_k) + p_k = R_k x_c + t_k.
  std::vector<float> bones;
  MatrixX3f rest_joints;           ///< j_k: J×3, followed by the nodes as sewn
  std::vector<float> correctives;  ///< V × 4 (the fourth 0): posed vertex minus linear blend skinning; or empty
  /// Including the nodes of a garment.
  [[nodiscard]] int num_joints() const { return static_cast<int>(rest_joints.rows()); }
};

/// Creates frames of one person; the shape is computed once. The model must outlive it.
class AvatarFrames {
 public:
  /// `betas` may be shorter than the body's; longer ones throw.
  AvatarFrames(const BodyModel& model, const Eigen::VectorXd& betas);

  /// Fills the frame of `pose` seen by a camera at `camera` (identity: `pose` is in the camera frame). Correctives are
  /// Σ_k w_k R_k (posedirs · vec(R − I)) of each vertex; empty for a body without. Reuses the memory of `frame`. The
  /// same bytes for any number of threads. Throws std::invalid_argument when the number of joints differs.
  void Make(const BodyPose& pose, const CameraPose& camera, int num_threads, AvatarFrame* frame) const;

 private:
  void MakeCorrectives(const std::vector<float>& features, int first, int last, AvatarFrame* frame) const;

  const BodyModel& model_;
  MatrixX3d rest_joints_;
};

// The skirt, dress or coat of a person of Gaussians as stored: its cut, and the nodes to which cloth Gaussians are
// bound.

struct AvatarGarment {
  /// For the body's shape in T-pose displaced by offsets_m; only waist, length, fullness and spacing are stored.
  LooseGarmentOptions cut;
  std::vector<float> offsets_m;  ///< V: offsets of clothes close to the skin along the normals
  double node_spacing_m = 0.05;  ///< geometry/cloth/cloth_nodes.h
  MatrixX3f nodes;               ///< K×3: positions of the nodes as sewn, rest space
  [[nodiscard]] int num_nodes() const { return static_cast<int>(nodes.rows()); }
};

}  // namespace bodyloom
