// SPDX-License-Identifier: Apache-2.0
/// The pose prior: a mixture of Gaussians over the joint rotations, and densities of limb directions. Learned from
/// motion capture by `bodyloom prior` (data_tools/learned/pose_prior_learning.h), stored in assets/prior.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

struct PosePrior {
  /// Mixture over x = axis-angle of `joints`, radians (3 values a joint, concatenated).
  std::vector<std::string> joints;           ///< joint names, in the order of x
  Eigen::VectorXd log_weights;               ///< K
  RowMatrixXd means;                         ///< K × dim
  std::vector<Eigen::MatrixXd> covariances;  ///< K of dim×dim

  /// Log density (natural, relative to uniform) of a limb's two bone directions in the torso frame (x left, y up,
  /// z front): row = direction of the upper bone, column = of the lower, as indices into DirectionBins of
  /// num_directions; for the left limb, the right one mirrors x. Empty when not learned.
  int num_directions = 0;
  RowMatrixXf arm_log_density, leg_log_density;

  [[nodiscard]] int dim() const { return static_cast<int>(3 * joints.size()); }
  [[nodiscard]] int num_components() const { return static_cast<int>(log_weights.size()); }
};

}  // namespace bodyloom
