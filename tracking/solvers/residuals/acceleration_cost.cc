// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/residuals/acceleration_cost.h"

#include <Eigen/Core>

#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using RowMatrix3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

namespace {

Eigen::Map<RowMatrix3d> Block(double* jacobian) { return Eigen::Map<RowMatrix3d>(jacobian); }

}  // namespace

AccelerationFactors AccelerationFactors::Of(double dt0, double dt1) {
  return {2 / ((dt0 + dt1) * dt0), 2 / ((dt0 + dt1) * dt1)};
}

void RotationAccelerationJacobians(const AccelerationFactors& factors, const Matrix3d& right0, const Matrix3d& right1,
                                   Matrix3d J[3]) {
  // log(exp(−δ) exp(a)) = a − Jr⁻¹(a)ᵀ δ to first order.
  J[0] = factors.earlier * right0.transpose();
  J[1] = -factors.later * right1.transpose() - factors.earlier * right0;
  J[2] = factors.later * right1;
}

RotationAccelerationCost::RotationAccelerationCost(double dt0, double dt1, double sigma) {
  BODYLOOM_CHECK(dt0 > 0 && dt1 > 0 && sigma > 0, "acceleration: time steps ", dt0, " and ", dt1, " s and sigma ",
                 sigma, " must be positive");
  factors_ = AccelerationFactors::Of(dt0, dt1);
  factors_.earlier /= sigma;
  factors_.later /= sigma;
}

bool RotationAccelerationCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const Matrix3d R0 = RotationFromAxisAngle(Eigen::Map<const Vector3d>(parameters[0]));
  const Matrix3d R1 = RotationFromAxisAngle(Eigen::Map<const Vector3d>(parameters[1]));
  const Matrix3d R2 = RotationFromAxisAngle(Eigen::Map<const Vector3d>(parameters[2]));
  const Vector3d step0 = AxisAngleFromRotation(R0.transpose() * R1);
  const Vector3d step1 = AxisAngleFromRotation(R1.transpose() * R2);
  Eigen::Map<Vector3d> r(residuals);
  r = factors_.later * step1 - factors_.earlier * step0;
  if (jacobians == nullptr) return true;
  Matrix3d J[3];
  RotationAccelerationJacobians(factors_, RightJacobianInverse(step0), RightJacobianInverse(step1), J);
  for (int k = 0; k < 3; ++k) {
    if (jacobians[k] != nullptr) Block(jacobians[k]) = J[k];
  }
  return true;
}

VectorAccelerationCost::VectorAccelerationCost(double dt0, double dt1, const double sigma[3]) {
  for (int c = 0; c < 3; ++c) {
    BODYLOOM_CHECK(dt0 > 0 && dt1 > 0 && sigma[c] > 0, "acceleration: time steps ", dt0, " and ", dt1, " s and sigma ",
                   sigma[c], " must be positive");
    const AccelerationFactors factors = AccelerationFactors::Of(dt0, dt1);
    scale0_[c] = factors.earlier / sigma[c];
    scale1_[c] = factors.later / sigma[c];
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

namespace {

using VelocityBlock = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;

VelocityBlock BlockOf(double* jacobian) { return VelocityBlock(jacobian); }

}  // namespace

void RotationStepJacobians(const Matrix3d& right, Matrix3d J[2]) {
  // log(exp(−δ) exp(a)) = a − Jr⁻¹(a)ᵀ δ to first order.
  J[0] = -right.transpose();
  J[1] = right;
}

RotationVelocityCost::RotationVelocityCost(double dt, double sigma) : scale_(1 / (dt * sigma)) {
  BODYLOOM_CHECK(dt > 0 && sigma > 0, "velocity: a time step of ", dt, " s and a sigma of ", sigma,
                 ", expected both above 0");
}

bool RotationVelocityCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const Matrix3d R0 = RotationFromAxisAngle(Eigen::Map<const Vector3d>(parameters[0]));
  const Matrix3d R1 = RotationFromAxisAngle(Eigen::Map<const Vector3d>(parameters[1]));
  const Vector3d step = AxisAngleFromRotation(R0.transpose() * R1);
  Eigen::Map<Vector3d> r(residuals);
  r = scale_ * step;
  if (jacobians == nullptr) return true;
  Matrix3d J[2];
  RotationStepJacobians(RightJacobianInverse(step), J);
  for (int k = 0; k < 2; ++k) {
    if (jacobians[k] != nullptr) BlockOf(jacobians[k]) = scale_ * J[k];
  }
  return true;
}

VectorVelocityCost::VectorVelocityCost(double dt, const double sigma[3]) {
  for (int c = 0; c < 3; ++c) {
    BODYLOOM_CHECK(dt > 0 && sigma[c] > 0, "velocity: a time step of ", dt, " s and a sigma of ", sigma[c],
                   ", expected both above 0");
    scale_[c] = 1 / (dt * sigma[c]);
  }
}

bool VectorVelocityCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  for (int c = 0; c < 3; ++c) residuals[c] = scale_[c] * (parameters[1][c] - parameters[0][c]);
  if (jacobians == nullptr) return true;
  for (int k = 0; k < 2; ++k) {
    if (jacobians[k] != nullptr) BlockOf(jacobians[k]) = (k == 0 ? -scale_ : scale_).asDiagonal();
  }
  return true;
}

}  // namespace bodyloom
