// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/frame_accumulator.h"

#include <algorithm>

#include "tracking/problem/panel_simd.h"

namespace bodyloom {

using Eigen::VectorXd;

namespace {

/// A squared residual so far beyond every kernel that ρ is its saturation to rounding.
constexpr double kBeyondKernels = 1e15;

/// Columns before those of further views, on which a layout's own terms do not depend.
int NumOwnColumns(const FrameLayout& layout) {
  return layout.beta_column + layout.num_betas + (layout.focal_column >= 0 ? 1 : 0) +
         (layout.clock_column >= 0 ? 2 : 0);
}

}  // namespace

void FrameAccumulator::Begin(const FrameLayout& layout, const FrameState& state, const VectorXd& betas,
                             double log_focal, Mode mode, FrameResiduals* residuals) {
  layout_ = &layout;
  state_ = &state;
  betas_ = &betas;
  log_focal_ = log_focal;
  clock_shift_s_ = 0;
  residuals_ = residuals;
  mode_ = mode;
  camera_ = layout.CameraAt(state, log_focal);
  kinematics_.Set(*layout.model, betas, state.rotations, layout.BodyTranslation(state), derivatives());
  vertices_.NewFrame(kinematics_);
  cost_ = 0;
  row_ = 0;
  num_invalid_ = 0;
  groups_.clear();
}

void FrameAccumulator::ReserveRows(int rows) {
  const int columns = layout_->num_columns;
  const int stride = panel_internal::RowStride(columns);
  if (J_.cols() != stride || J_.rows() < rows) J_.setZero(rows, stride);
  if (r_.size() < rows) r_.resize(rows);
  H_.setZero(columns, stride);
  gradient_.setZero(columns);
  cost_ = 0;
  row_ = 0;
  num_invalid_ = 0;
  groups_.clear();
}

void FrameAccumulator::BeginGroup(int num_rows, double squared_norm, double kernel, double weight) {
  ResidualGroup& group = groups_.emplace_back();
  group.first_row = row_;
  group.num_rows = num_rows;
  group.kernel = kernel;
  group.weight = weight;
  if (mode_ != Mode::kNorms) return;
  NextResiduals(num_rows).setZero();
  NextResiduals(num_rows)[0] = std::sqrt(squared_norm);
  TakeRows(num_rows);
}

double FrameAccumulator::AddGroup(int num_rows, double squared_norm, double rho, double d_rho,
                                  ceres::LossFunction* loss) {
  cost_ += 0.5 * rho;
  if (!one_by_one()) return std::sqrt(d_rho);
  BeginGroup(num_rows, squared_norm, 0, 1);
  groups_.back().loss = loss;
  return 1;
}

void FrameAccumulator::AddSaturated(double kernel, double weight, int num_rows) {
  cost_ += 0.5 * weight * kernel * kernel;
  ++num_invalid_;
  if (!one_by_one()) return;
  const double beyond = kBeyondKernels * kernel;
  BeginGroup(num_rows, beyond * beyond, kernel, weight);
  if (!derivatives()) return;
  NextRows(num_rows).setZero();
  NextResiduals(num_rows).setZero();
  NextResiduals(num_rows)[0] = beyond;
  TakeRows(num_rows);
  if (mode_ != Mode::kStructure) return;
  DependsOnPoint();
  DependsOn(layout_->TranslationBlock());
  DependsOn(layout_->FocalBlock());
  DependsOn(layout_->ClockBlock());
}

void FrameAccumulator::DependsOn(int block) {
  if (mode_ != Mode::kStructure || block < 0) return;
  std::vector<int>& blocks = groups_.back().blocks;
  const auto at = std::lower_bound(blocks.begin(), blocks.end(), block);
  if (at == blocks.end() || *at != block) blocks.insert(at, block);
}

void FrameAccumulator::DependsOnPoint() {
  if (mode_ != Mode::kStructure) return;
  for (const int j : points_.joints()) {
    if (layout_->column_of_joint[j] >= 0) DependsOn(layout_->BlockOfColumn(layout_->column_of_joint[j]));
  }
  DependsOn(layout_->BetaBlock());
}

void FrameAccumulator::FillPointRows(Eigen::Ref<RowMatrixXd> rows) {
  const FrameLayout& layout = *layout_;
  rows.setZero();
  for (int j : points_.joints()) {
    const int column = layout.column_of_joint[j];
    if (column >= 0) rows.middleCols<3>(column) = points_.JointJacobian(kinematics_, j);
  }
  if (layout.num_betas > 0) rows.middleCols(layout.beta_column, layout.num_betas) = points_.ShapeJacobian();
}

void FrameAccumulator::Finish(FrameSystem* system) {
  system->cost = cost_;
  system->num_invalid = num_invalid_;
  if (!derivatives()) return;
  const int p = layout_->num_columns;
  if (row_ > 0) {
    panel_internal::Products products;
    products.a = products.b = J_.data();
    products.c = H_.data();
    products.lda = products.ldb = J_.cols();
    products.ldc = H_.cols();
    products.rows = products.columns = NumOwnColumns(*layout_);
    products.last = row_;
    products.upper = true;
    panel_internal::AddProducts(products);
    gradient_.noalias() += J_.topLeftCorner(row_, p).transpose() * r_.head(row_);
  }
  system->gradient = gradient_;
  if (system->H.rows() != p) system->H.setZero(p, p);
  // The upper triangle by rows is the lower one by columns.
  for (int i = 0; i < p; ++i) std::copy(&H_(i, i), &H_(i, 0) + p, &system->H(i, i));
}

}  // namespace bodyloom
