// SPDX-License-Identifier: Apache-2.0
/// Rotations as 3×3 matrices and their exponential coordinates (axis-angle, radians), stable from 0 to π.
/// Formulas: Solà, Deray, Atchuthan, "A micro Lie theory", section on SO(3).
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace bodyloom {

/// [w]×, so that Skew(w) * x = w × x.
Eigen::Matrix3d Skew(const Eigen::Vector3d& w);

/// exp([w]×): the rotation by |w| radians about w, a rotation to rounding for every finite w. Series below 1e-4 rad.
Eigen::Matrix3d RotationFromAxisAngle(const Eigen::Vector3d& w);

/// The axis-angle of R with angle in [0, π]. At π the axis' sign is free; the first non-zero component is positive.
/// R must be a rotation to about 1e-6.
Eigen::Vector3d AxisAngleFromRotation(const Eigen::Matrix3d& R);

/// Right Jacobian: exp(w + dw) = exp(w) exp(RightJacobian(w) dw) to first order.
Eigen::Matrix3d RightJacobian(const Eigen::Vector3d& w);

/// Inverse of RightJacobian: log(exp(w) exp(d)) = w + RightJacobianInverse(w) d to first order. Valid for |w| < 2π.
Eigen::Matrix3d RightJacobianInverse(const Eigen::Vector3d& w);

/// ∂vec(R exp([δ]×))/∂δ at δ = 0, 9×3; vec takes a matrix row by row.
Eigen::Matrix<double, 9, 3> EntriesByIncrement(const Eigen::Matrix3d& R);

/// The rotation nearest to M in the Frobenius norm (polar factor with determinant +1); NaN when M is not finite.
Eigen::Matrix3d NearestRotation(const Eigen::Matrix3d& M);

/// Angle of the relative rotation AᵀB, radians in [0, π].
double RotationAngleBetween(const Eigen::Matrix3d& A, const Eigen::Matrix3d& B);

/// Geodesic interpolation A exp(t log(AᵀB)).
Eigen::Matrix3d InterpolateRotation(const Eigen::Matrix3d& A, const Eigen::Matrix3d& B, double t);

/// The shortest rotation that takes the direction of `from` to that of `to`; for opposite vectors a half turn about
/// any perpendicular axis; identity if either is zero.
Eigen::Matrix3d RotationBetweenDirections(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// Returns true if R·Rᵀ is the identity within `tolerance` (Eigen's isIdentity) and det R is positive; false when R is
/// not finite.
inline bool IsRotation(const Eigen::Matrix3d& R, double tolerance) {
  return (R * R.transpose()).isIdentity(tolerance) && R.determinant() > 0;
}

}  // namespace bodyloom
