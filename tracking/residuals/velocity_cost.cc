// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/residuals/velocity_cost.h"

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/rotation.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

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
