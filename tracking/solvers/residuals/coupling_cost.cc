// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/residuals/coupling_cost.h"

#include "geometry/math/rotation.h"

namespace bodyloom {

using Eigen::Vector3d;
using Eigen::VectorXd;

CouplingCost::CouplingCost(const FrameCoupling& coupling, const FrameLayout& layout,
                           const std::vector<FrameState>& states)
    : coupling_(coupling), layout_(layout), states_(states) {
  set_num_residuals(coupling.cost.function->num_residuals());
  std::vector<const FrameState*> read;
  for (const int t : coupling.frames) read.push_back(&states[t]);
  UserResidual residual;
  EvaluateUserCost(coupling.cost, layout, read, VectorXd::Zero(layout.num_betas), 0, true, &residual);
  const int of_frame = layout.TranslationBlock() + 1, frames = static_cast<int>(read.size());
  for (int i = 0; i < static_cast<int>(residual.reads.size()); ++i) {
    if (residual.reads[i] == 0) continue;
    const bool shared = i >= frames * of_frame;
    parameters_.push_back({shared ? -1 : i / of_frame, shared ? of_frame + i - frames * of_frame : i % of_frame});
    mutable_parameter_block_sizes()->push_back(layout.NumColumns(parameters_.back().block));
  }
}

bool CouplingCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  std::vector<FrameState> states;
  for (const int t : coupling_.frames) states.push_back(states_[t]);
  VectorXd betas = VectorXd::Zero(layout_.num_betas);
  double log_focal = 0;
  for (size_t i = 0; i < parameters_.size(); ++i) {
    const auto [frame, block] = parameters_[i];
    const double* values = parameters[i];
    if (block == layout_.BetaBlock()) {
      betas = Eigen::Map<const VectorXd>(values, layout_.num_betas);
    } else if (block == layout_.FocalBlock()) {
      log_focal = *values;
    } else if (block == layout_.TranslationBlock()) {
      states[frame].translation = Eigen::Map<const Vector3d>(values);
    } else {
      states[frame].rotations[layout_.active_joints[block]] = RotationFromAxisAngle(Eigen::Map<const Vector3d>(values));
    }
  }
  std::vector<const FrameState*> read;
  for (const FrameState& state : states) read.push_back(&state);
  UserResidual result;
  EvaluateUserCost(coupling_.cost, layout_, read, betas, log_focal, jacobians != nullptr, &result);
  if (!result.valid) return false;
  Eigen::Map<VectorXd>(residuals, num_residuals()) = result.r;
  if (jacobians == nullptr) return true;
  const int n = layout_.num_frame_columns(), frames = static_cast<int>(states.size());
  for (size_t i = 0; i < parameters_.size(); ++i) {
    if (jacobians[i] == nullptr) continue;
    const auto [frame, block] = parameters_[i];
    const int columns = layout_.NumColumns(block), first = layout_.FirstColumn(block);
    const int column = frame >= 0 ? frame * n + first : frames * n + first - layout_.beta_column;
    Eigen::Map<RowMatrixXd>(jacobians[i], num_residuals(), columns) = result.J.middleCols(column, columns);
  }
  return true;
}

}  // namespace bodyloom
