// SPDX-License-Identifier: Apache-2.0
/// A foot that stands on a plane that several people share:
///   r = (u · p + h e^{−x}) / σ
/// p: place of the foot on the floor in its person's own fit, camera axes, metres. A person who is e^x times as large,
/// seen as large, is e^x times as far away: the foot is at e^x p, and on the plane {q : u · q = −h} when r = 0. It is
/// divided by e^x, because σ is of p. Parameters: u (3, unit, up), h (1, camera above the plane, metres), x (1).
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>
#include <cmath>

namespace bodyloom {

class StanceCost : public ceres::SizedCostFunction<1, 3, 1, 1> {
 public:
  StanceCost(const Eigen::Vector3d& place_m, double sigma_m) : place_m_(place_m), sigma_m_(sigma_m) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Eigen::Vector3d> up(parameters[0]);
    const double height = parameters[1][0], smaller = std::exp(-parameters[2][0]);
    residuals[0] = (up.dot(place_m_) + height * smaller) / sigma_m_;
    if (jacobians == nullptr) return true;
    for (int k = 0; jacobians[0] != nullptr && k < 3; ++k) jacobians[0][k] = place_m_[k] / sigma_m_;
    if (jacobians[1] != nullptr) jacobians[1][0] = smaller / sigma_m_;
    if (jacobians[2] != nullptr) jacobians[2][0] = -height * smaller / sigma_m_;
    return true;
  }

 private:
  Eigen::Vector3d place_m_;
  double sigma_m_;
};

}  // namespace bodyloom
