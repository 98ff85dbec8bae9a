// SPDX-License-Identifier: Apache-2.0
/// What a person's Gaussians need to know of a frame: the bones, and the pose correctives of the skin.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/cloth/loose_garment.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"

namespace bodyloom {

/// In the frame that the Gaussians are wanted in, usually the camera's.
struct AvatarFrame {
  /// J × 12, and as many for each node of a garment (render/gaussian_avatar/cloth_bones.h): rows of [R_k | t_k], t_k =
  /// p_k − R_k j_k: a point x_c of rest space that is fixed to bone k goes to R_k (x_c − j_k) + p_k = R_k x_c + t_k.
  std::vector<float> bones;
  MatrixX3f rest_joints;           ///< J×3 and the nodes as sewn: j_k
  std::vector<float> correctives;  ///< V × 4 (the fourth 0): posed vertex minus plain skinning; or empty
  /// With the nodes of a garment.
  [[nodiscard]] int num_joints() const { return static_cast<int>(rest_joints.rows()); }
};

/// Makes frames of one person; the shape is worked out once. The model must outlive it.
class AvatarFrames {
 public:
  /// betas may be shorter than the body's; longer throws.
  AvatarFrames(const BodyModel& model, const Eigen::VectorXd& betas);

  /// The frame of `pose` seen by a camera at `camera` (identity: `pose` is in the camera frame already). Correctives
  /// are Σ_k w_k R_k (posedirs · vec(R − I)) of each vertex, left out for a body that has none. Keeps frame->…'s
  /// memory. The same bytes for any number of threads. Throws std::invalid_argument when the pose has another number of
  /// joints.
  void Make(const BodyPose& pose, const CameraPose& camera, int num_threads, AvatarFrame* frame) const;

 private:
  void MakeCorrectives(const std::vector<float>& features, int first, int last, AvatarFrame* frame) const;

  const BodyModel& model_;
  MatrixX3d rest_joints_;
};

// The skirt, dress or coat that a person of Gaussians wears, as it is stored: how to cut it, and the nodes that the
// Gaussians of cloth hang on.

struct AvatarGarment {
  /// Of the body's shape in T-pose, with what offsets_m adds; only waist, length, fullness and spacing are stored.
  LooseGarmentOptions cut;
  std::vector<float> offsets_m;  ///< V: how far clothes close to the skin stand off along the normal
  double node_spacing_m = 0.05;  ///< geometry/cloth/cloth_nodes.h
  MatrixX3f nodes;               ///< K×3: places of the nodes as sewn, rest space
  [[nodiscard]] int num_nodes() const { return static_cast<int>(nodes.rows()); }
};

}  // namespace bodyloom
