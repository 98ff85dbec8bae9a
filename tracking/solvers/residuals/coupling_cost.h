// SPDX-License-Identifier: Apache-2.0
/// A user's cost function on several frames (problem/user_cost.h) as a Ceres cost function of the clip's parameters,
/// before its loss.
#pragma once

#include <ceres/cost_function.h>

#include <vector>

#include "tracking/problem/user_cost.h"

namespace bodyloom {

/// Parameter blocks are those that the function may depend on: of each frame the axis-angle of active joints and the
/// translation, then betas and the logarithm of the focal length. Jacobians are by right increments and must be used
/// with RotationManifold. Everything is borrowed.
class CouplingCost : public ceres::CostFunction {
 public:
  struct Parameter {
    int frame = 0;  ///< index into the coupling's frames; −1: shared
    int block = 0;  ///< FrameLayout's number
  };
  /// `states`: of the whole problem; they give the rotations of joints that are not active.
  CouplingCost(const FrameCoupling& coupling, const FrameLayout& layout, const std::vector<FrameState>& states);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;
  [[nodiscard]] const std::vector<Parameter>& parameters() const { return parameters_; }

 private:
  const FrameCoupling& coupling_;
  const FrameLayout& layout_;
  const std::vector<FrameState>& states_;
  std::vector<Parameter> parameters_;
};

}  // namespace bodyloom
