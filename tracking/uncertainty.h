// SPDX-License-Identifier: Apache-2.0
/// Uncertainty of each joint's position: from the same normal equations that the solve used (docs/chain_solver.md,
/// "Uncertainty").
#pragma once

#include <Eigen/Core>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/tracking/sequence_problem.h"

namespace bodyloom {

/// J standard deviations of the joints' positions in the camera frame, metres: √(trace(D_j P D_jᵀ) / 3), D_j the
/// derivative of joint j by a frame's columns and by the shared values, P their covariance (chain/chain_covariance.h).
/// For weak perspective the depth of the whole body is not part of it.
Eigen::VectorXd JointSigmaOf(const FrameLayout& layout, const FrameState& state, const Eigen::VectorXd& betas,
                             const Eigen::MatrixXd& P);

/// T×J of these at the problem's current state, with shape and focal length unknown. Observations, priors and
/// smoothness count with the weights they have in the cost, so a limb that nobody saw has the spread of the prior. NaN
/// where the system is singular. Linear in the number of frames; the same bytes for any number of threads.
/// `focal_log_sigma`, unless null, becomes the standard deviation of the logarithm of the focal length; it stays as it is
/// when the focal length is known or the system singular.
RowMatrixXd JointPositionSigma(const SequenceProblem& problem, int num_threads, double* focal_log_sigma = nullptr);

}  // namespace bodyloom
