// SPDX-License-Identifier: Apache-2.0
/// The surface Jacobian, by pose, shape and translation: exact first derivatives of the body model,
/// geometry/body/body_model.h, pose correctives and shape-dependent joints included. Double, one frame.
///
/// Joint rotations vary on the right: R_j ← R_j exp([δ_j]×), which is smooth everywhere, π included. For a vertex v
/// with weights w_i, moved by bone i to x_i, let S_j = Σ_{i below or at j} w_i x_i and W_j = Σ_{i below or at j} w_i.
/// Then
///   ∂v/∂δ_j = −[S_j − W_j p_j]× G_j + M P_j ∂vec_rowmajor(R_j exp([δ_j]×))/∂δ_j,      M = Σ_i w_i G_i
///   ∂v/∂β   = M S + Σ_i w_i ∂t_i/∂β,                                               t_i = p_i − G_i rest_i
///   ∂v/∂t   = I
/// with P_j the vertex' corrective block of joint j and S its rows of shapedirs. For derivatives by axis-angle multiply
/// the block of joint j with RightJacobian (geometry/math/rotation.h).
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"

namespace bodyloom {

/// A point in the frame of the pose, metres, and its derivatives.
struct PointJacobian {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  std::vector<int> joints;                          ///< ascending; no other joint's rotation moves the point
  std::vector<Eigen::Matrix3d> d_point_d_rotation;  ///< ∂point/∂δ_j, metres a radian, one for each of `joints`
  Eigen::Matrix3Xd d_point_d_betas;                 ///< 3 × as many betas as were given
  double d_point_d_trans = 0;                       ///< times the identity: the sum of the weights, 1 for a point
};

/// Immutable after construction and safe to share between threads. The model must outlive it. Construction costs
/// O(J·B), a point O(J + corrective blocks + B).
class SurfaceJacobian {
 public:
  /// betas may be shorter than the body's. Throws std::invalid_argument when betas are too many or the pose has another
  /// number of joints than the body.
  SurfaceJacobian(const BodyModel& model, const Eigen::VectorXd& betas, const BodyPose& pose);
  SurfaceJacobian(BodyModel&&, const Eigen::VectorXd&, const BodyPose&) = delete;

  /// Throws std::invalid_argument when the body has no such face.
  [[nodiscard]] PointJacobian At(const SurfacePoint& point) const;

  /// The Jacobian of Σ_k weights[k] · vertex(vertices[k]), for example of a Landmark. Vertices of weight zero are left
  /// out. Throws std::invalid_argument on a vertex outside the body or spans of different length.
  [[nodiscard]] PointJacobian OfVertices(std::span<const int> vertices, std::span<const double> weights) const;

  /// The Jacobian of a joint's position. Throws std::invalid_argument when the body has no such joint.
  [[nodiscard]] PointJacobian OfJoint(int joint) const;

  [[nodiscard]] const PosedSkeleton& skeleton() const { return skeleton_; }

 private:
  const BodyModel& model_;
  Eigen::VectorXd betas_;
  BodyPose pose_;
  PosedSkeleton skeleton_;
  std::vector<Eigen::Vector3d> offset_;             ///< t_i
  std::vector<Eigen::Matrix3Xd> d_joint_d_betas_;   ///< ∂p_i/∂β
  std::vector<Eigen::Matrix3Xd> d_offset_d_betas_;  ///< ∂t_i/∂β
};

}  // namespace bodyloom
