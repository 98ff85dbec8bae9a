// SPDX-License-Identifier: Apache-2.0
#include "tracking/frame_cost.h"

#include <cmath>
#include <utility>

#include "geometry/check.h"
#include "geometry/rotation.h"
#include "tracking/robust.h"

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
  if (J_.cols() != columns || J_.rows() < rows) J_.resize(rows, columns);
  if (r_.size() < rows) r_.resize(rows);
}

void FrameEvaluator::AddPixel(const FrameLayout& layout, const Vector3d& x, const Vector2d& pixel, double sigma_px,
                              double kernel, const FrameState& state, bool derivatives) {
  Vector2d projected;
  Matrix2x3d d_pixel_d_x;
  if (!camera_.Project(x, &projected, derivatives ? &d_pixel_d_x : nullptr)) {
    cost_ += 0.5 * kernel * kernel;
    ++num_invalid_;
    return;
  }
  const Vector2d residual = (projected - pixel) / sigma_px;
  const RobustValue robust = GemanMcClure(residual.squaredNorm(), kernel);
  cost_ += 0.5 * robust.rho;
  if (!derivatives) return;
  const double scale = std::sqrt(robust.weight);
  const Matrix2x3d A = (scale / sigma_px) * d_pixel_d_x;
  auto rows = J_.middleRows<2>(row_);
  rows.setZero();
  for (int j : points_.joints()) {
    const int column = layout.column_of_joint[j];
    if (column >= 0) rows.middleCols<3>(column).noalias() = A * points_.JointJacobian(kinematics_, j);
  }
  if (layout.knowledge == CameraKnowledge::kWeak) {
    const double s = camera_.scale * scale / sigma_px;
    rows.col(layout.translation_column) = s * Vector2d(x.x() + camera_.tx, x.y() + camera_.ty);
    rows(0, layout.translation_column + 1) = s;
    rows(1, layout.translation_column + 2) = s;
  } else {
    rows.middleCols<3>(layout.translation_column) = A;
  }
  if (layout.num_betas > 0) {
    rows.middleCols(layout.beta_column, layout.num_betas).noalias() = A * points_.ShapeJacobian();
  }
  if (layout.focal_column >= 0) {
    rows.col(layout.focal_column) = (scale / sigma_px) * (projected - Vector2d(camera_.cx, camera_.cy));
  }
  r_.segment<2>(row_) = scale * residual;
  row_ += 2;
}

void FrameEvaluator::Evaluate(const FrameLayout& layout, const FrameData& data, const FrameState& state,
                              const VectorXd& betas, double log_focal, bool derivatives, FrameSystem* system) {
  const int p = layout.num_columns;
  camera_ = layout.camera;
  Vector3d trans = state.translation;
  if (layout.knowledge == CameraKnowledge::kWeak) {
    camera_.scale = std::exp(state.translation[0]);
    camera_.tx = state.translation[1];
    camera_.ty = state.translation[2];
    trans.setZero();
  } else if (layout.knowledge == CameraKnowledge::kUnknownFocal) {
    camera_.fx = camera_.fy = std::exp(log_focal);
  }
  kinematics_.Set(*layout.model, betas, state.rotations, trans, derivatives);
  cost_ = 0;
  row_ = 0;
  num_invalid_ = 0;
  const size_t num_dense = data.dense != nullptr ? data.dense->size() : 0;
  const bool use_prior = data.prior != nullptr && !data.prior->empty() && data.prior_weight > 0;
  if (derivatives) {
    const size_t rows = 2 * (data.landmarks.size() + num_dense) + (use_prior ? 3 * data.prior->joints().size() : 0) +
                        (data.limits != nullptr ? 3 * data.limits->ranges.size() : 0) +
                        (data.upright_weight > 0 ? 1 : 0) +
                        (data.initial_rotations.empty() ? 0 : 3 * layout.active_joints.size() + 3);
    ReserveRows(static_cast<int>(rows), p);
  }

  for (const LandmarkObservation& observation : data.landmarks) {
    const Vector3d x = points_.Evaluate(kinematics_, *observation.point, derivatives);
    AddPixel(layout, x, observation.pixel, observation.sigma_px, data.landmark_kernel, state, derivatives);
  }
  if (num_dense > 0) {
    vertices_.NewFrame(kinematics_);
    const MatrixX3i& faces = layout.model->data().faces;
    for (const DenseKeypoint& point : *data.dense) {
      const Vector3d x = points_.Evaluate(kinematics_, faces.row(point.face).data(), point.barycentric.data(),
                                          &vertices_, derivatives);
      AddPixel(layout, x, point.pixel.cast<double>(), point.sigma_px, data.dense_kernel, state, derivatives);
    }
  }

  if (use_prior) {
    const std::vector<int>& joints = data.prior->joints();
    VectorXd x(3 * joints.size());
    for (size_t i = 0; i < joints.size(); ++i) {
      x.segment<3>(3 * i) = AxisAngleFromRotation(state.rotations[joints[i]]);
    }
    double energy;
    const int k = data.prior->Nearest(x, &energy);
    cost_ += 0.5 * data.prior_weight * energy;
    if (derivatives) {
      const double scale = std::sqrt(data.prior_weight);
      const Eigen::MatrixXd& L = data.prior->sqrt_precision(k);
      const int n = static_cast<int>(x.size());
      J_.middleRows(row_, n).setZero();
      for (size_t i = 0; i < joints.size(); ++i) {
        const int column = layout.column_of_joint[joints[i]];
        const Matrix3d d_x = scale * RightJacobianInverse(x.segment<3>(3 * i));
        J_.block(row_, column, n, 3).noalias() = L.middleCols<3>(3 * i) * d_x;
      }
      const VectorXd centred = scale * (x - data.prior->mean(k));
      r_.segment(row_, n) = L.triangularView<Eigen::Upper>() * centred;
      row_ += n;
    }
  }

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
      J_.middleRows<3>(row_).setZero();
      J_.block<3, 3>(row_, column) = d_excess;
      r_.segment<3>(row_) = excess;
      row_ += 3;
    }
  }

  if (data.upright_weight > 0 && layout.column_of_joint[0] >= 0) {
    const Matrix3d& root = state.rotations[0];
    const double r = root(2, 1) / kUprightSigma;
    const RobustValue robust = GemanMcClure(r * r, kUprightKernel);
    cost_ += 0.5 * data.upright_weight * robust.rho;
    if (derivatives) {
      const double scale = std::sqrt(data.upright_weight * robust.weight);
      J_.row(row_).setZero();
      J_.block<1, 3>(row_, layout.column_of_joint[0]) = -scale / kUprightSigma * root.row(2) * Skew(Vector3d::UnitY());
      r_[row_++] = scale * r;
    }
  }

  if (!data.initial_rotations.empty() && data.initialiser_weight > 0) {
    const double rotation_scale = std::sqrt(data.initialiser_weight) / data.initialiser_sigma;
    for (int j : layout.active_joints) {
      const Vector3d w = AxisAngleFromRotation(data.initial_rotations[j].transpose() * state.rotations[j]);
      cost_ += 0.5 * rotation_scale * rotation_scale * w.squaredNorm();
      if (!derivatives) continue;
      J_.middleRows<3>(row_).setZero();
      J_.block<3, 3>(row_, layout.column_of_joint[j]) = rotation_scale * RightJacobianInverse(w);
      r_.segment<3>(row_) = rotation_scale * w;
      row_ += 3;
    }
    const double translation_scale = std::sqrt(data.initialiser_weight) / data.initialiser_translation_sigma;
    const Vector3d offset = state.translation - data.initial_translation;
    cost_ += 0.5 * translation_scale * translation_scale * offset.squaredNorm();
    if (derivatives) {
      J_.middleRows<3>(row_).setZero();
      J_.block<3, 3>(row_, layout.translation_column) = translation_scale * Matrix3d::Identity();
      r_.segment<3>(row_) = translation_scale * offset;
      row_ += 3;
    }
  }

  system->cost = cost_;
  system->num_invalid = num_invalid_;
  if (derivatives) {
    system->H.setZero(p, p);
    system->gradient.setZero(p);
    if (row_ > 0) {  // Eigen's blocking divides by the number of rows
      system->H.selfadjointView<Eigen::Lower>().rankUpdate(J_.topRows(row_).transpose());
      system->gradient.noalias() = J_.topRows(row_).transpose() * r_.head(row_);
    }
  }
}

}  // namespace bodyloom
