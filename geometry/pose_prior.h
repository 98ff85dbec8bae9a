// SPDX-License-Identifier: Apache-2.0
/// Which poses people take: a mixture of Gaussians over the joint rotations, and examples of limb directions.
/// Learned from motion capture by `bodyloom body make-prior` (data_tools/pose_prior_learning.h), stored in assets/prior.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "geometry/arrays.h"

namespace bodyloom {

struct PosePrior {
  /// Mixture over x = axis-angle of `joints`, radians (3 values a joint, concatenated).
  std::vector<std::string> joints;           ///< joint names, in the order of x
  Eigen::VectorXd log_weights;               ///< K
  RowMatrixXd means;                         ///< K × dim
  std::vector<Eigen::MatrixXd> sqrt_precisions;  ///< K of dim×dim upper triangular L with LᵀL = Σ⁻¹

  /// Limb examples in the torso frame (x left, y up, z front): unit vectors (upper, lower) of one limb, 6 values a row,
  /// for the left side; the right side mirrors x.
  MatrixX3d arm_upper, arm_lower, leg_upper, leg_lower;  ///< N×3 each

  [[nodiscard]] int dim() const { return static_cast<int>(3 * joints.size()); }
  [[nodiscard]] int num_components() const { return static_cast<int>(log_weights.size()); }
};

}  // namespace bodyloom
