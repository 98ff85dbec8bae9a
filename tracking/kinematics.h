// SPDX-License-Identifier: Apache-2.0
/// The kinematic tree of one frame with everything its derivatives need; scratch memory that is reused between frames.
///
/// Bone j maps a rest point x to G_j x + t_j with t_j = p_j − G_j rest_j, p_j the joint's position. Rotations are
/// differentiated by right increments R_j ← R_j exp(δ_j).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bodyloom/geometry/body_model.h"

namespace bodyloom {

struct Kinematics {
  using Matrix93d = Eigen::Matrix<double, 9, 3>;
  using Matrix3Bd = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 32>;
  static constexpr int kMaxBetas = 32;

  const BodyModel* model = nullptr;
  Eigen::VectorXd betas;                             ///< the first n shape components in use
  std::vector<Eigen::Matrix3d> R, G;                 ///< J local and world rotations
  std::vector<Eigen::Vector3d> p, rest, t;           ///< J joint positions, rest joints, bone offsets
  std::vector<Matrix3Bd> dp, dt;                     ///< J derivatives of p and t by betas, 3×n
  std::vector<Matrix93d> feature_jacobian;           ///< J: d vec_rowmajor(R_j) / d δ_j
  std::vector<Eigen::Matrix<double, 9, 1>> feature;  ///< J: vec_rowmajor(R_j − I)

  /// Sets shape and pose. `rotations` holds J matrices. Derivatives are filled only when requested.
  void Set(const BodyModel& body, const Eigen::VectorXd& shape, const std::vector<Eigen::Matrix3d>& rotations,
           const Eigen::Vector3d& trans, bool derivatives);
};

}  // namespace bodyloom
