// SPDX-License-Identifier: Apache-2.0
/// Gaussian prior on one parameter block: r = A x + b.
#pragma once

#include <ceres/cost_function.h>

#include <utility>

#include "bodyloom/geometry/arrays.h"

namespace bodyloom {

class LinearCost : public ceres::CostFunction {
 public:
  LinearCost(RowMatrixXd A, Eigen::VectorXd b) : A_(std::move(A)), b_(std::move(b)) {
    set_num_residuals(static_cast<int>(A_.rows()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(A_.cols()));
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    Eigen::Map<Eigen::VectorXd> r(residuals, A_.rows());
    r = A_ * Eigen::Map<const Eigen::VectorXd>(parameters[0], A_.cols()) + b_;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMatrixXd> J(jacobians[0], A_.rows(), A_.cols());
      J = A_;
    }
    return true;
  }

 private:
  RowMatrixXd A_;
  Eigen::VectorXd b_;
};

}  // namespace bodyloom
