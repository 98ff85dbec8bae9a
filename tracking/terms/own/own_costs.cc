// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/terms/own/own_costs.h"

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bodyloom/tracking/frame_accumulator.h"
#include "bodyloom/tracking/kinematics.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// The numbers that a cost function reads, one block after the other.
class BlockValues {
 public:
  double* Append(int size) {
    offsets_.push_back(values_.size());
    values_.resize(values_.size() + static_cast<size_t>(size));
    return &values_[offsets_.back()];
  }
  /// Valid until the next Append().
  [[nodiscard]] std::vector<const double*> Pointers() const {
    std::vector<const double*> pointers;
    for (const size_t offset : offsets_) pointers.push_back(&values_[offset]);
    return pointers;
  }

 private:
  std::vector<size_t> offsets_;
  std::vector<double> values_;
};

void AppendPose(const OwnBlocks& blocks, const FrameState& state, BlockValues* values) {
  if (blocks.translation) Eigen::Map<Vector3d>(values->Append(3)) = state.translation;
  for (const int j : blocks.joints) {
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values->Append(9)) = state.rotations[j];
  }
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::vector<CompiledPoint> CompileOwnLandmarks(const OwnTerm& term, const BodyModel& model, int num_betas) {
  CheckOwnTerm(term, model);
  std::vector<CompiledPoint> points;
  for (const std::string& name : term.landmarks) {
    const Landmark& landmark = model.data().landmarks[model.FindLandmark(name)];
    points.push_back(CompilePoint(model, landmark.vertices, landmark.weights, num_betas));
  }
  return points;
}

OwnLoss EvaluateOwnLoss(const OwnCost& cost, double s) {
  if (cost.loss == nullptr) return {s, 1};
  double rho[3];
  cost.loss->Evaluate(s, rho);
  return {rho[0], std::max(0.0, rho[1])};
}

Vector3d OwnOrigin(const FrameLayout& layout, const FrameState& state, Matrix3d* d_origin) {
  d_origin->setIdentity();
  if (layout.knowledge != CameraKnowledge::kWeak) return Vector3d::Zero();
  Vector3d origin = layout.BodyPlace(state);
  d_origin->col(0) = -origin.z() * Vector3d::UnitZ();
  d_origin->col(1) = Vector3d::UnitX();
  d_origin->col(2) = Vector3d::UnitY();
  return origin;
}

int OwnCostsOfFrame::num_rows() const {
  int rows = 0;
  for (const OwnCost& cost : costs) rows += cost.function->num_residuals();
  return rows;
}

void OwnCostsOfFrame::Add(FrameAccumulator* sums) const {
  if (costs.empty()) return;
  const FrameLayout& layout = sums->layout();
  const FrameState& state = sums->state();
  const int p = layout.num_columns;
  Matrix3d d_origin;
  const Vector3d origin = OwnOrigin(layout, state, &d_origin);
  for (const OwnCost& cost : costs) {
    const OwnBlocks& blocks = *cost.blocks;
    const int num_residuals = cost.function->num_residuals();
    const std::vector<int>& sizes = cost.function->parameter_block_sizes();
    // ∂blocks/∂unknowns, block after block.
    int size = 0;
    for (const int s : sizes) size += s;
    RowMatrixXd d_blocks;
    if (sums->derivatives()) d_blocks.setZero(size, p);
    BlockValues values;
    int row = 0;
    for (const CompiledPoint& point : blocks.points) {
      Eigen::Map<Vector3d>(values.Append(3)) =
          sums->points().Evaluate(sums->kinematics(), point, sums->derivatives()) + origin;
      if (!sums->derivatives()) continue;
      sums->FillPointRows(d_blocks.middleRows(row, 3));
      d_blocks.block<3, 3>(row, layout.translation_column) = d_origin;
      row += 3;
    }
    AppendPose(blocks, state, &values);
    if (sums->derivatives()) {
      if (blocks.translation) {
        d_blocks.block<3, 3>(row, layout.translation_column).setIdentity();
        row += 3;
      }
      for (const int j : blocks.joints) {
        const int column = layout.column_of_joint[j];
        if (column >= 0) d_blocks.block<9, 3>(row, column) = sums->kinematics().feature_jacobian[j];
        row += 9;
      }
    }
    VectorXd r(num_residuals);
    std::vector<RowMatrixXd> by_block;
    std::vector<double*> jacobians;
    if (sums->derivatives()) {
      for (const int s : sizes) by_block.emplace_back(num_residuals, s);
      for (RowMatrixXd& block : by_block) jacobians.push_back(block.data());
    }
    if (!cost.function->Evaluate(values.Pointers().data(), r.data(), jacobians.empty() ? nullptr : jacobians.data())) {
      sums->AddCost(kNaN);
      continue;
    }
    const OwnLoss loss = EvaluateOwnLoss(cost, r.squaredNorm());
    sums->AddCost(0.5 * loss.rho);
    if (!sums->derivatives()) continue;
    RowMatrixXd by_blocks(num_residuals, size);
    for (int b = 0, at = 0; b < static_cast<int>(sizes.size()); at += sizes[b++]) {
      by_blocks.middleCols(at, sizes[b]) = by_block[b];
    }
    const double scale = std::sqrt(loss.weight);
    auto rows = sums->NextRows(num_residuals);
    rows.setZero();
    rows.leftCols(p).noalias() = scale * by_blocks * d_blocks;
    sums->NextResiduals(num_residuals) = scale * r;
    sums->TakeRows(num_residuals);
  }
}

double OwnCostAt(const OwnCost& cost, const FrameLayout& layout, const FrameState& state, const VectorXd& betas) {
  Kinematics kinematics;
  PointEvaluator points;
  kinematics.Set(*layout.model, betas, state.rotations, layout.BodyTranslation(state), false);
  Matrix3d d_origin;
  const Vector3d origin = OwnOrigin(layout, state, &d_origin);
  BlockValues values;
  for (const CompiledPoint& point : cost.blocks->points) {
    Eigen::Map<Vector3d>(values.Append(3)) = points.Evaluate(kinematics, point, false) + origin;
  }
  AppendPose(*cost.blocks, state, &values);
  VectorXd r(cost.function->num_residuals());
  if (!cost.function->Evaluate(values.Pointers().data(), r.data(), nullptr)) return kNaN;
  return 0.5 * EvaluateOwnLoss(cost, r.squaredNorm()).rho;
}

}  // namespace bodyloom
