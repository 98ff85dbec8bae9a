// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/frame_accumulator.h"

#include <algorithm>

#include "bodyloom/tracking/chain/panel_simd.h"

namespace bodyloom {

using Eigen::VectorXd;

void FrameAccumulator::Begin(const FrameLayout& layout, const FrameState& state, const VectorXd& betas,
                             double log_focal, bool derivatives, FrameResiduals* residuals) {
  layout_ = &layout;
  state_ = &state;
  betas_ = &betas;
  residuals_ = residuals;
  derivatives_ = derivatives;
  camera_ = layout.CameraAt(state, log_focal);
  kinematics_.Set(*layout.model, betas, state.rotations, layout.BodyTranslation(state), derivatives);
  vertices_.NewFrame(kinematics_);
  cost_ = 0;
  row_ = 0;
  num_invalid_ = 0;
}

void FrameAccumulator::ReserveRows(int rows) {
  const int columns = layout_->num_columns;
  const int stride = panel_internal::RowStride(columns);
  if (J_.cols() != stride || J_.rows() < rows) J_.setZero(rows, stride);
  if (r_.size() < rows) r_.resize(rows);
  H_.setZero(columns, stride);
  gradient_.setZero(columns);
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
  if (!derivatives_) return;
  const int p = layout_->num_columns;
  if (row_ > 0) {
    panel_internal::Products products;
    products.a = products.b = J_.data();
    products.c = H_.data();
    products.lda = products.ldb = J_.cols();
    products.ldc = H_.cols();
    products.rows = products.columns = p;
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
