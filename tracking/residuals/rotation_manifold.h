// SPDX-License-Identifier: Apache-2.0
/// SO(3) stored as axis-angle: Plus(w, δ) = log(exp(w) exp(δ)).
///
/// PlusJacobian is declared the identity: cost functions on such blocks give their derivatives by the increment δ
/// directly ("lifted" Jacobians), which saves a 3×3 product for each block and is exact because Ceres only ever uses
/// the product of the two. A block must therefore not be mixed with cost functions that differentiate by w.
#pragma once

#include <ceres/manifold.h>

#include "bodyloom/geometry/rotation.h"

namespace bodyloom {

class RotationManifold : public ceres::Manifold {
 public:
  [[nodiscard]] int AmbientSize() const override { return 3; }
  [[nodiscard]] int TangentSize() const override { return 3; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    using Vector = Eigen::Map<const Eigen::Vector3d>;
    Eigen::Map<Eigen::Vector3d> result(x_plus_delta);
    result = AxisAngleFromRotation(RotationFromAxisAngle(Vector(x)) * RotationFromAxisAngle(Vector(delta)));
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix3d> J(jacobian);
    J.setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    using Vector = Eigen::Map<const Eigen::Vector3d>;
    Eigen::Map<Eigen::Vector3d> result(y_minus_x);
    result = AxisAngleFromRotation(RotationFromAxisAngle(Vector(x)).transpose() * RotationFromAxisAngle(Vector(y)));
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix3d> J(jacobian);
    J.setIdentity();
    return true;
  }
};

}  // namespace bodyloom
