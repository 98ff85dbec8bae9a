// SPDX-License-Identifier: Apache-2.0
/// Loss, prior and manifold for Ceres.
#pragma once

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <utility>

#include "geometry/math/arrays.h"
#include "geometry/math/rotation.h"
#include "tracking/problem/robust.h"

namespace bodyloom {

/// The robust kernel of robust.h: ρ(s) = c² s / (c² + s).
class GemanMcClureLoss : public ceres::LossFunction {
 public:
  /// c > 0 in standard deviations.
  explicit GemanMcClureLoss(double c) : c_(c) {}
  void Evaluate(double s, double rho[3]) const override {
    const RobustValue value = GemanMcClure(s, c_);
    rho[0] = value.rho;
    rho[1] = value.weight;
    rho[2] = -2 * value.weight / (c_ * c_ + s);
  }

 private:
  double c_;
};

// Gaussian prior on parameter blocks: r = A x + b, with x the blocks one after another.

class LinearCost : public ceres::CostFunction {
 public:
  /// `blocks`: their sizes; empty: one block of all columns.
  LinearCost(RowMatrixXd A, Eigen::VectorXd b, std::vector<int> blocks = {}) : A_(std::move(A)), b_(std::move(b)) {
    if (blocks.empty()) blocks = {static_cast<int>(A_.cols())};
    set_num_residuals(static_cast<int>(A_.rows()));
    *mutable_parameter_block_sizes() = std::move(blocks);
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    Eigen::Map<Eigen::VectorXd> r(residuals, A_.rows());
    r = b_;
    Eigen::Index column = 0;
    for (size_t i = 0; i < parameter_block_sizes().size(); ++i) {
      const int size = parameter_block_sizes()[i];
      const auto A = A_.middleCols(column, size);
      r += A * Eigen::Map<const Eigen::VectorXd>(parameters[i], size);
      if (jacobians != nullptr && jacobians[i] != nullptr) {
        Eigen::Map<RowMatrixXd> J(jacobians[i], A.rows(), size);
        J = A;
      }
      column += size;
    }
    return true;
  }

 private:
  RowMatrixXd A_;
  Eigen::VectorXd b_;
};

// SO(3) stored as axis-angle: Plus(w, δ) = log(exp(w) exp(δ)).
//
// PlusJacobian is the identity: cost functions on such blocks return their derivatives by the increment δ directly
// ("lifted" Jacobians), which saves a 3×3 product for each block and is exact because Ceres only uses the product of
// the two. Such blocks must therefore not be used with cost functions that differentiate by w.

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
