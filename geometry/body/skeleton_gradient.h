// SPDX-License-Identifier: Apache-2.0
/// Reverse pass of PoseSkeleton (geometry/body/posed_body.h): derivatives of a loss by a pose from those by its bones.
///
/// With G_d, p_d the rotation and position of joint d, A_d = d loss/d G_d (entry by entry) and a_d = d loss/d p_d: a
/// turn R_j ← R_j exp([δ]×) turns joint j and all below it about p_j by ω = G_j δ, so that
///   d loss/d ω = τ_j = Σ_d [ Σ_c (G_d e_c) × (A_d e_c) + (p_d − p_j) × a_d ],   d below j or j itself
///   d loss/d δ = G_jᵀ τ_j,   d loss/d trans = Σ_d a_d
/// summed from the leaves to the root in the order of the joints, so the result is bitwise reproducible.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "geometry/body/posed_body.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

struct SkeletonGradient {
  MatrixX3d by_turns;        ///< J×3: by δ_j of R_j exp([δ_j]×), at zero
  Eigen::Vector3d by_trans;  ///< in the frame of the skeleton's joints
};

/// `parents`: the body's. `by_rotations`: J; `by_joints`: J×3. Throws std::invalid_argument for tables of other sizes.
SkeletonGradient SkeletonBackward(std::span<const int> parents, const PosedSkeleton& skeleton,
                                  std::span<const Eigen::Matrix3d> by_rotations, const MatrixX3d& by_joints);

/// Jacobian of the joint positions by the pose, 3J × (3J + 3): rows x, y, z of each joint in turn, columns the
/// rotations δ_j as above, then trans.
Eigen::MatrixXd JointJacobian(std::span<const int> parents, const PosedSkeleton& skeleton);

}  // namespace bodyloom
