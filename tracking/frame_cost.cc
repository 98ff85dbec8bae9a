// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/frame_cost.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/rotation.h"
#include "bodyloom/tracking/chain/panel_simd.h"
#include "bodyloom/tracking/residuals/lifted_pose.h"
#include "bodyloom/tracking/residuals/part_label_term.h"
#include "bodyloom/tracking/robust.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

FrameLayout FrameLayout::Make(const BodyModel& model, CameraKnowledge knowledge, const Camera& camera,
                              std::vector<int> active_joints, int num_betas) {
  FrameLayout layout;
  layout.model = &model;
  layout.knowledge = knowledge;
  layout.camera = camera;
  layout.camera.model = knowledge == CameraKnowledge::kWeak ? CameraModel::kWeakPerspective : CameraModel::kPinhole;
  layout.active_joints = std::move(active_joints);
  layout.column_of_joint.assign(model.num_joints(), -1);
  int column = 0;
  for (int j : layout.active_joints) {
    layout.column_of_joint[j] = column;
    column += 3;
  }
  layout.translation_column = column;
  column += 3;
  layout.beta_column = column;
  layout.num_betas = num_betas;
  column += num_betas;
  if (knowledge == CameraKnowledge::kUnknownFocal) layout.focal_column = column++;
  layout.num_columns = column;
  return layout;
}

Camera FrameLayout::CameraAt(const FrameState& state, double log_focal) const {
  Camera result = camera;
  if (knowledge == CameraKnowledge::kWeak) {
    result.scale = std::exp(state.translation[0]);
    result.tx = state.translation[1];
    result.ty = state.translation[2];
  } else if (knowledge == CameraKnowledge::kUnknownFocal) {
    result.fx = result.fy = std::exp(log_focal);
  }
  return result;
}

Vector3d FrameLayout::BodyTranslation(const FrameState& state) const {
  return knowledge == CameraKnowledge::kWeak ? Vector3d::Zero() : state.translation;
}

Vector3d FrameLayout::BodyPlace(const FrameState& state) const {
  if (knowledge != CameraKnowledge::kWeak) return state.translation;
  return {state.translation[1], state.translation[2], camera.fx * std::exp(-state.translation[0])};
}

FrameState InterpolateStates(const FrameState& a, const FrameState& b, double s) {
  FrameState result;
  result.rotations.reserve(a.rotations.size());
  for (size_t j = 0; j < a.rotations.size(); ++j) {
    result.rotations.push_back(InterpolateRotation(a.rotations[j], b.rotations[j], s));
  }
  result.translation = (1 - s) * a.translation + s * b.translation;
  return result;
}

void FrameEvaluator::ReserveRows(int rows, int columns) {
  const int stride = panel_internal::RowStride(columns);
  if (J_.cols() != stride || J_.rows() < rows) J_.setZero(rows, stride);
  if (r_.size() < rows) r_.resize(rows);
  H_.setZero(columns, stride);
  gradient_.setZero(columns);
}

void FrameEvaluator::AddSquares(int column, const Matrix3d& JtJ, const Vector3d& Jtr) {
  H_.block<3, 3>(column, column) += JtJ;
  gradient_.segment<3>(column) += Jtr;
}

void FrameEvaluator::AddPrior(const FrameLayout& layout, const FrameData& data, const FrameState& state,
                              bool derivatives) {
  const std::vector<int>& joints = data.prior->joints();
  VectorXd x(3 * joints.size());
  for (size_t i = 0; i < joints.size(); ++i) x.segment<3>(3 * i) = AxisAngleFromRotation(state.rotations[joints[i]]);
  double energy;
  const int k = data.prior->Nearest(x, &energy);
  cost_ += 0.5 * data.prior_weight * energy;
  if (!derivatives) return;
  const Eigen::MatrixXd& precision = data.prior->precision(k);
  std::vector<Matrix3d> d_x(joints.size());
  for (size_t i = 0; i < joints.size(); ++i) d_x[i] = RightJacobianInverse(x.segment<3>(3 * i));
  const VectorXd force = data.prior_weight * (precision * (x - data.prior->mean(k)));
  for (size_t i = 0; i < joints.size(); ++i) {
    const int row = layout.column_of_joint[joints[i]];
    gradient_.segment<3>(row) += d_x[i].transpose() * force.segment<3>(3 * i);
    for (size_t j = 0; j < joints.size(); ++j) {
      const int column = layout.column_of_joint[joints[j]];
      if (column < row) continue;
      const Matrix3d half = data.prior_weight * d_x[i].transpose() * precision.block<3, 3>(3 * i, 3 * j);
      H_.block<3, 3>(row, column) += half * d_x[j];
    }
  }
}

void FrameEvaluator::Evaluate(const FrameLayout& layout, const FrameData& data, const FrameState& state,
                              const VectorXd& betas, double log_focal, bool derivatives, FrameSystem* system,
                              FrameResiduals* residuals) {
  const int p = layout.num_columns;
  camera_ = layout.CameraAt(state, log_focal);
  kinematics_.Set(*layout.model, betas, state.rotations, layout.BodyTranslation(state), derivatives);
  cost_ = 0;
  row_ = 0;
  num_invalid_ = 0;
  const size_t num_dense = data.dense != nullptr ? data.dense->size() : 0;
  const bool use_prior = data.prior != nullptr && !data.prior->empty() && data.prior_weight > 0;
  const bool use_lifted = data.lifted != nullptr && data.lifted_weight > 0;
  if (derivatives) {
    const size_t rows = 2 * (data.landmarks.size() + (data.rendered_uv != nullptr ? num_dense : 0)) +
                        (data.part_labels != nullptr ? static_cast<size_t>(data.part_labels->num_rows()) : 0) +
                        (use_lifted ? 3 * data.lifted->points.size() + 3 : 0) + 3 * data.contacts.size();
    ReserveRows(static_cast<int>(rows), p);
  }

  for (const LandmarkObservation& observation : data.landmarks) {
    const Vector3d x = points_.Evaluate(kinematics_, *observation.point, derivatives);
    AddPixel(layout, x, observation.pixel, Eigen::Matrix2d::Identity() / observation.sigma_px, data.landmark_kernel, 1,
             derivatives);
  }
  vertices_.NewFrame(kinematics_);
  if (num_dense > 0) AddDense(layout, data, derivatives);
  if (data.rendered_uv != nullptr) AddRenderedUv(layout, data, state, betas, derivatives, residuals);
  if (data.part_labels != nullptr) AddPartLabels(layout, data, derivatives, residuals);
  if (use_lifted) AddLifted(layout, data, derivatives);
  if (!data.contacts.empty()) AddContacts(layout, data, state, derivatives);

  if (use_prior) AddPrior(layout, data, state, derivatives);

  if (data.limits != nullptr) {
    for (const JointLimits::Range& range : data.limits->ranges) {
      const int column = layout.column_of_joint[range.joint];
      if (column < 0) continue;
      const Vector3d w = AxisAngleFromRotation(state.rotations[range.joint]);
      const Vector3d excess = LimitExcess(range, w) / data.limit_sigma;
      if (excess.isZero(0)) continue;
      cost_ += 0.5 * excess.squaredNorm();
      if (!derivatives) continue;
      Matrix3d d_excess = RightJacobianInverse(w) / data.limit_sigma;
      for (int c = 0; c < 3; ++c) {
        if (excess[c] == 0) d_excess.row(c).setZero();
      }
      AddSquares(column, d_excess.transpose() * d_excess, d_excess.transpose() * excess);
    }
  }

  if (data.upright_weight > 0 && layout.column_of_joint[0] >= 0) {
    const Matrix3d& root = state.rotations[0];
    const double r = data.upright_normal.dot(root.col(1)) / kUprightSigma;
    const RobustValue robust = GemanMcClure(r * r, kUprightKernel);
    cost_ += 0.5 * data.upright_weight * robust.rho;
    if (derivatives) {
      const double scale = std::sqrt(data.upright_weight * robust.weight);
      const Eigen::RowVector3d row =
          -scale / kUprightSigma * data.upright_normal.transpose() * root * Skew(Vector3d::UnitY());
      AddSquares(layout.column_of_joint[0], row.transpose() * row, row.transpose() * (scale * r));
    }
  }

  if (!data.initial_rotations.empty() && data.initialiser_weight > 0) {
    const double rotation_scale = std::sqrt(data.initialiser_weight) / data.initialiser_sigma;
    for (int j : layout.active_joints) {
      const Vector3d w = AxisAngleFromRotation(data.initial_rotations[j].transpose() * state.rotations[j]);
      cost_ += 0.5 * rotation_scale * rotation_scale * w.squaredNorm();
      if (!derivatives) continue;
      const Matrix3d d_w = rotation_scale * RightJacobianInverse(w);
      AddSquares(layout.column_of_joint[j], d_w.transpose() * d_w, rotation_scale * (d_w.transpose() * w));
    }
    const double translation_scale = std::sqrt(data.initialiser_weight) / data.initialiser_translation_sigma;
    const Vector3d offset = state.translation - data.initial_translation;
    cost_ += 0.5 * translation_scale * translation_scale * offset.squaredNorm();
    if (derivatives) {
      const double information = translation_scale * translation_scale;
      AddSquares(layout.translation_column, information * Matrix3d::Identity(), information * offset);
    }
  }

  system->cost = cost_;
  system->num_invalid = num_invalid_;
  if (!derivatives) return;
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
