// SPDX-License-Identifier: Apache-2.0
/// How well each joint's position is known: from the same normal equations that the solve used.
#pragma once

#include <vector>

#include "geometry/arrays.h"
#include "tracking/sequence_problem.h"

namespace bodyloom {

/// Diagonal blocks of the inverse of a symmetric positive definite block-tridiagonal matrix.
/// `diagonal[i]` is n_i×n_i, `upper[i]` = block (i, i+1). Linear in the number of blocks (forward elimination, then
/// P_i = S_i⁻¹ + K_i P_{i+1} K_iᵀ with K_i = S_i⁻¹ C_i). Empty when the matrix is not positive definite.
std::vector<Eigen::MatrixXd> BlockTridiagonalInverseDiagonal(const std::vector<Eigen::MatrixXd>& diagonal,
                                                             const std::vector<Eigen::MatrixXd>& upper);

/// T×J standard deviation of each joint's position, metres: √(trace of its 3×3 covariance / 3), given shape and focal
/// length, at the problem's current state. Observations, priors and smoothness count with the weights they have in the
/// cost, so a limb that nobody saw has the spread of the prior. NaN where the system is singular.
/// For weak perspective the depth of the whole body is not part of it.
RowMatrixXd JointPositionSigma(const SequenceProblem& problem);

}  // namespace bodyloom
