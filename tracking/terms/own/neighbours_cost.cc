// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/terms/own/neighbours_cost.h"

#include <array>

#include "bodyloom/geometry/rotation.h"
#include "bodyloom/tracking/kinematics.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

void EvaluateNeighbours(const OwnCost& cost, const FrameLayout& layout, const FrameState& first,
                        const FrameState& second, const VectorXd& betas, bool derivatives, NeighboursResidual* result) {
  const int n = layout.num_frame_columns(), B = layout.num_betas;
  const auto K = static_cast<int>(cost.blocks->points.size());
  VectorXd values(6 * K);
  RowMatrixXd d_values;
  if (derivatives) d_values.setZero(6 * K, 2 * n + B);
  Kinematics kinematics;
  PointEvaluator points;
  for (int frame = 0; frame < 2; ++frame) {
    const FrameState& state = frame == 0 ? first : second;
    kinematics.Set(*layout.model, betas, state.rotations, layout.BodyTranslation(state), derivatives);
    Matrix3d d_origin;
    const Vector3d origin = OwnOrigin(layout, state, &d_origin);
    for (int k = 0; k < K; ++k) {
      const int row = 3 * (frame * K + k);
      values.segment<3>(row) = points.Evaluate(kinematics, cost.blocks->points[k], derivatives) + origin;
      if (!derivatives) continue;
      for (const int j : points.joints()) {
        const int column = layout.column_of_joint[j];
        if (column >= 0) d_values.block<3, 3>(row, frame * n + column) = points.JointJacobian(kinematics, j);
      }
      d_values.block<3, 3>(row, frame * n + layout.translation_column) = d_origin;
      if (B > 0) d_values.block(row, 2 * n, 3, B) = points.ShapeJacobian();
    }
  }
  const int num_residuals = cost.function->num_residuals();
  std::vector<const double*> parameters;
  std::vector<RowMatrixXd> by_block;
  std::vector<double*> jacobians;
  for (int b = 0; b < 2 * K; ++b) {
    parameters.push_back(values.data() + 3 * b);
    if (derivatives) by_block.emplace_back(num_residuals, 3);
  }
  jacobians.reserve(by_block.size());
  for (RowMatrixXd& block : by_block) jacobians.push_back(block.data());
  result->r.resize(num_residuals);
  result->valid =
      cost.function->Evaluate(parameters.data(), result->r.data(), derivatives ? jacobians.data() : nullptr);
  if (!result->valid || !derivatives) return;
  result->J.setZero(num_residuals, 2 * n + B);
  for (int b = 0; b < 2 * K; ++b) result->J += by_block[b] * d_values.middleRows(3 * b, 3);
}

NeighboursCost::NeighboursCost(const OwnCost& cost, const FrameLayout& layout, const FrameState& first,
                               const FrameState& second)
    : cost_(cost), layout_(layout), first_(first), second_(second) {
  for (size_t i = 0; i < 2 * (layout.active_joints.size() + 1); ++i) mutable_parameter_block_sizes()->push_back(3);
  if (layout.num_betas > 0) mutable_parameter_block_sizes()->push_back(layout.num_betas);
  set_num_residuals(cost.function->num_residuals());
}

bool NeighboursCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  std::array<FrameState, 2> states = {first_, second_};
  int block = 0;
  for (FrameState& state : states) {
    for (const int j : layout_.active_joints) {
      state.rotations[j] = RotationFromAxisAngle(Eigen::Map<const Vector3d>(parameters[block++]));
    }
    state.translation = Eigen::Map<const Vector3d>(parameters[block++]);
  }
  VectorXd betas(layout_.num_betas);
  if (layout_.num_betas > 0) betas = Eigen::Map<const VectorXd>(parameters[block++], layout_.num_betas);
  NeighboursResidual result;
  EvaluateNeighbours(cost_, layout_, states[0], states[1], betas, jacobians != nullptr, &result);
  if (!result.valid || !result.r.allFinite()) return false;
  Eigen::Map<VectorXd>(residuals, num_residuals()) = result.r;
  if (jacobians == nullptr) return true;
  // A frame's columns stand in the order of its blocks.
  int column = 0;
  for (int b = 0; b < block; ++b) {
    const int size = parameter_block_sizes()[b];
    if (jacobians[b] != nullptr) {
      Eigen::Map<RowMatrixXd>(jacobians[b], num_residuals(), size) = result.J.middleCols(column, size);
    }
    column += size;
  }
  return true;
}

}  // namespace bodyloom
