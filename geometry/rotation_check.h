// SPDX-License-Identifier: Apache-2.0
/// Whether a matrix that somebody gives is a rotation.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace bodyloom {

/// R·Rᵀ is the identity within `tolerance` (Eigen's isIdentity), and R is no mirror. False for what is not finite.
inline bool IsRotation(const Eigen::Matrix3d& R, double tolerance) {
  return (R * R.transpose()).isIdentity(tolerance) && R.determinant() > 0;
}

}  // namespace bodyloom
