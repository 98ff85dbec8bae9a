// SPDX-License-Identifier: Apache-2.0
/// min ‖A x − b‖² subject to x ≥ 0, given AᵀA and Aᵀb.
/// Source: Lawson and Hanson, "Solving Least Squares Problems", 1974, chapter 23 (active sets), on the normal
/// equations.
#pragma once

#include <Eigen/Core>

namespace bodyloom {

/// AᵀA n×n positive definite (add a ridge when it may not be), Aᵀb n. At the result every x_i ≥ 0 has gradient zero and
/// every x_i = 0 a gradient that does not point inwards (to about 1e-9 of its scale). Throws std::invalid_argument on
/// sizes that disagree and values that are not finite.
Eigen::VectorXd SolveNonnegative(const Eigen::MatrixXd& AtA, const Eigen::VectorXd& Atb);

}  // namespace bodyloom
