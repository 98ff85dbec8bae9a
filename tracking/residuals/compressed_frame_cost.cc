// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/residuals/compressed_frame_cost.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/geometry/rotation.h"

namespace bodyloom {

using Eigen::MatrixXd;
using Eigen::VectorXd;

void SquareRootSystem(const MatrixXd& H, const VectorXd& g, MatrixXd* R, VectorXd* y) {
  const Eigen::Index n = H.rows();
  const double tolerance = 1e-14 * H.diagonal().cwiseAbs().maxCoeff();
  const Eigen::LLT<MatrixXd, Eigen::Lower> factor(H);
  if (factor.info() == Eigen::Success && factor.matrixLLT().diagonal().minCoeff() > std::sqrt(tolerance)) {
    *R = factor.matrixU();
    *y = factor.matrixL().solve(g);
    return;
  }
  // Semi-definite: left-looking Cholesky that leaves a zero row for every parameter nothing depends on.
  R->setZero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double pivot = H(i, i) - R->col(i).head(i).squaredNorm();
    if (!(pivot > tolerance)) continue;
    const double root = std::sqrt(pivot);
    (*R)(i, i) = root;
    for (Eigen::Index j = i + 1; j < n; ++j) {
      (*R)(i, j) = (H(j, i) - R->col(i).head(i).dot(R->col(j).head(i))) / root;
    }
  }
  y->resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double root = (*R)(i, i);
    (*y)[i] = root > 0 ? (g[i] - R->col(i).head(i).dot(y->head(i))) / root : 0.0;
  }
}

CompressedFrameCost::CompressedFrameCost(const FrameLayout& layout, const FrameData& data, const FrameState& held)
    : layout_(layout), data_(data), held_(held) {
  for (size_t i = 0; i < layout.active_joints.size() + 1; ++i) mutable_parameter_block_sizes()->push_back(3);
  if (layout.num_betas > 0) mutable_parameter_block_sizes()->push_back(layout.num_betas);
  if (layout.focal_column >= 0) mutable_parameter_block_sizes()->push_back(1);
  set_num_residuals(layout.num_columns + 1);
}

bool CompressedFrameCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  thread_local FrameEvaluator evaluator;
  thread_local FrameSystem system;
  thread_local FrameState state;
  thread_local VectorXd betas;
  thread_local MatrixXd R;
  thread_local VectorXd y;
  state = held_;
  int block = 0;
  for (int j : layout_.active_joints) {
    state.rotations[j] = RotationFromAxisAngle(Eigen::Map<const Eigen::Vector3d>(parameters[block++]));
  }
  state.translation = Eigen::Map<const Eigen::Vector3d>(parameters[block++]);
  betas.resize(layout_.num_betas);
  if (layout_.num_betas > 0) betas = Eigen::Map<const VectorXd>(parameters[block++], layout_.num_betas);
  const double log_focal = layout_.focal_column >= 0 ? parameters[block++][0] : 0.0;
  const bool derivatives = jacobians != nullptr;
  evaluator.Evaluate(layout_, data_, state, betas, log_focal, derivatives, &system);
  if (!std::isfinite(system.cost)) return false;
  const int p = layout_.num_columns;
  Eigen::Map<VectorXd> r(residuals, p + 1);
  if (!derivatives) {
    r.setZero();
    r[p] = std::sqrt(2 * system.cost);
    return true;
  }
  SquareRootSystem(system.H, system.gradient, &R, &y);
  r.head(p) = y;
  r[p] = std::sqrt(std::max(0.0, 2 * system.cost - y.squaredNorm()));
  int column = 0;
  for (int b = 0; b < block; ++b) {
    const int size = parameter_block_sizes()[b];
    if (jacobians[b] != nullptr) {
      Eigen::Map<RowMatrixXd> J(jacobians[b], p + 1, size);
      J.topRows(p) = R.middleCols(column, size);
      J.row(p).setZero();
    }
    column += size;
  }
  return true;
}

/// Copies a frame's residuals and Jacobians out of the batch.
class FrameBatch::HandOut : public ceres::CostFunction {
 public:
  explicit HandOut(const Frame& frame) : frame_(frame) {
    *mutable_parameter_block_sizes() = frame.cost->parameter_block_sizes();
    set_num_residuals(frame.cost->num_residuals());
  }
  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    if (!frame_.valid) return false;
    std::copy(frame_.residuals.begin(), frame_.residuals.end(), residuals);
    if (jacobians == nullptr) return true;
    const double* next = frame_.jacobian.data();
    for (size_t b = 0; b < parameter_block_sizes().size(); ++b) {
      const size_t size = static_cast<size_t>(num_residuals()) * parameter_block_sizes()[b];
      if (jacobians[b] != nullptr) std::copy(next, next + size, jacobians[b]);
      next += size;
    }
    return true;
  }

 private:
  const Frame& frame_;
};

ceres::CostFunction* FrameBatch::Add(std::unique_ptr<CompressedFrameCost> cost, std::vector<double*> blocks) {
  auto frame = std::make_unique<Frame>();
  frame->residuals.resize(cost->num_residuals());
  frame->cost = std::move(cost);
  frame->blocks = std::move(blocks);
  frames_.push_back(std::move(frame));
  return new HandOut(*frames_.back());
}

void FrameBatch::PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) {
  if (!new_evaluation_point && (has_jacobians_ || !evaluate_jacobians)) return;
  has_jacobians_ = evaluate_jacobians;
  ParallelFor(static_cast<int>(frames_.size()), num_threads_, [&](int t) {
    Frame& frame = *frames_[t];
    const std::vector<int>& sizes = frame.cost->parameter_block_sizes();
    std::vector<double*> jacobians;
    if (evaluate_jacobians) {
      size_t columns = 0;
      for (int size : sizes) columns += size;
      frame.jacobian.resize(columns * frame.residuals.size());
      double* next = frame.jacobian.data();
      for (int size : sizes) {
        jacobians.push_back(next);
        next += static_cast<size_t>(size) * frame.residuals.size();
      }
    }
    frame.valid = frame.cost->Evaluate(frame.blocks.data(), frame.residuals.data(),
                                       evaluate_jacobians ? jacobians.data() : nullptr);
  });
}

}  // namespace bodyloom
