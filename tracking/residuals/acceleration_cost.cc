// SPDX-License-Identifier: Apache-2.0
#include "tracking/residuals/acceleration_cost.h"

#include <Eigen/Core>

#include "geometry/check.h"
#include "geometry/rotation.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using RowMatrix3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

namespace {

Eigen::Map<RowMatrix3d> Block(double* jacobian) { return Eigen::Map<RowMatrix3d>(jacobian); }

}  // namespace

RotationAccelerationCost::RotationAccelerationCost(double dt0, double dt1, double sigma) {
  BODYLOOM_CHECK(dt0 > 0 && dt1 > 0 && sigma > 0, "acceleration: time steps ", dt0, " and ", dt1, " s and sigma ",
                 sigma, " must be positive");
  scale0_ = 2 / ((dt0 + dt1) * dt0 * sigma);
  scale1_ = 2 / ((dt0 + dt1) * dt1 * sigma);
}

bool RotationAccelerationCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const Matrix3d R0 = RotationFromAxisAngle(Eigen::Map<const Vector3d>(parameters[0]));
  const Matrix3d R1 = RotationFromAxisAngle(Eigen::Map<const Vector3d>(parameters[1]));
  const Matrix3d R2 = RotationFromAxisAngle(Eigen::Map<const Vector3d>(parameters[2]));
  const Vector3d step0 = AxisAngleFromRotation(R0.transpose() * R1);
  const Vector3d step1 = AxisAngleFromRotation(R1.transpose() * R2);
  Eigen::Map<Vector3d> r(residuals);
  r = scale1_ * step1 - scale0_ * step0;
  if (jacobians == nullptr) return true;
  const Matrix3d right0 = RightJacobianInverse(step0), right1 = RightJacobianInverse(step1);
  // log(exp(−δ) exp(a)) = a − Jr⁻¹(a)ᵀ δ to first order.
  if (jacobians[0] != nullptr) Block(jacobians[0]) = scale0_ * right0.transpose();
  if (jacobians[1] != nullptr) Block(jacobians[1]) = -scale1_ * right1.transpose() - scale0_ * right0;
  if (jacobians[2] != nullptr) Block(jacobians[2]) = scale1_ * right1;
  return true;
}

VectorAccelerationCost::VectorAccelerationCost(double dt0, double dt1, const double sigma[3]) {
  for (int c = 0; c < 3; ++c) {
    BODYLOOM_CHECK(dt0 > 0 && dt1 > 0 && sigma[c] > 0, "acceleration: time steps ", dt0, " and ", dt1, " s and sigma ",
                   sigma[c], " must be positive");
    scale0_[c] = 2 / ((dt0 + dt1) * dt0 * sigma[c]);
    scale1_[c] = 2 / ((dt0 + dt1) * dt1 * sigma[c]);
  }
}

bool VectorAccelerationCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  for (int c = 0; c < 3; ++c) {
    residuals[c] =
        scale1_[c] * (parameters[2][c] - parameters[1][c]) - scale0_[c] * (parameters[1][c] - parameters[0][c]);
  }
  if (jacobians == nullptr) return true;
  for (int block = 0; block < 3; ++block) {
    if (jacobians[block] == nullptr) continue;
    Eigen::Map<RowMatrix3d> J(jacobians[block]);
    J.setZero();
    for (int c = 0; c < 3; ++c) {
      J(c, c) = block == 0 ? scale0_[c] : block == 1 ? -scale0_[c] - scale1_[c] : scale1_[c];
    }
  }
  return true;
}

}  // namespace bodyloom
