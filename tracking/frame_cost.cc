// SPDX-License-Identifier: Apache-2.0
#include "tracking/frame_cost.h"

#include <cmath>
#include <utility>

#include "geometry/check.h"
#include "geometry/rotation.h"
#include "tracking/residuals/lifted_pose.h"
#include "tracking/residuals/part_label_term.h"
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
    // A keypoint has its two rows in UV or in the image.
    const size_t rows = 2 * (data.landmarks.size() + num_dense) +
                        (data.part_labels != nullptr ? static_cast<size_t>(data.part_labels->num_rows()) : 0) +
                        (use_prior ? 3 * data.prior->joints().size() : 0) +
                        (data.limits != nullptr ? 3 * data.limits->ranges.size() : 0) +
                        (data.upright_weight > 0 ? 1 : 0) + (use_lifted ? 3 * data.lifted->points.size() + 3 : 0) +
                        (data.initial_rotations.empty() ? 0 : 3 * layout.active_joints.size() + 3);
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
