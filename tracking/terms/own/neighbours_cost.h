// SPDX-License-Identifier: Apache-2.0
/// A user's own cost function on the landmarks of two neighbouring frames (own_term.h, OwnTerm::Reads::kNeighbours).
#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <vector>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/tracking/frame_layout.h"
#include "bodyloom/tracking/terms/own/own_costs.h"

namespace bodyloom {

/// The residual before the loss, and its derivative.
struct NeighboursResidual {
  bool valid = false;
  Eigen::VectorXd r;
  RowMatrixXd J;  ///< columns: frame t (num_frame_columns()), frame t + 1, betas
};

/// `result->J` only with derivatives.
void EvaluateNeighbours(const OwnCost& cost, const FrameLayout& layout, const FrameState& first,
                        const FrameState& second, const Eigen::VectorXd& betas, bool derivatives,
                        NeighboursResidual* result);

/// The same as a Ceres cost function, before the loss. Parameter blocks: the axis-angle of each active joint and the
/// translation of frame t, the same of frame t + 1, betas (if any). Jacobians are by right increments and must be used
/// with RotationManifold. `first` and `second` give the rotations of joints that are not active. Everything is
/// borrowed.
class NeighboursCost : public ceres::CostFunction {
 public:
  NeighboursCost(const OwnCost& cost, const FrameLayout& layout, const FrameState& first, const FrameState& second);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  const OwnCost& cost_;
  const FrameLayout& layout_;
  const FrameState &first_, &second_;
};

}  // namespace bodyloom
