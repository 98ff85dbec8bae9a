// SPDX-License-Identifier: Apache-2.0
// The lifter's term of FrameEvaluator (residuals/lifted_pose.h).
#include <cmath>

#include "bodyloom/tracking/frame_cost.h"
#include "bodyloom/tracking/initialise/lifter_input.h"
#include "bodyloom/tracking/residuals/lifted_pose.h"
#include "bodyloom/tracking/robust.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void FrameEvaluator::FillPointRows(const FrameLayout& layout, Eigen::Ref<RowMatrixXd> rows) {
  rows.setZero();
  for (int j : points_.joints()) {
    const int column = layout.column_of_joint[j];
    if (column >= 0) rows.middleCols<3>(column) = points_.JointJacobian(kinematics_, j);
  }
  if (layout.num_betas > 0) rows.middleCols(layout.beta_column, layout.num_betas) = points_.ShapeJacobian();
}

void FrameEvaluator::AddLifted(const FrameLayout& layout, const FrameData& data, bool derivatives) {
  const LiftedPose& lifted = *data.lifted;
  const LiftedLandmarks& landmarks = *lifted.landmarks;
  // The translation moves landmark and mid-hip alike, so its columns stay zero.
  Vector3d hips = Vector3d::Zero();
  if (derivatives) hip_rows_.setZero(3, J_.cols());
  for (int k = kLifterLeftHip; k <= kLifterLeftHip + 1; ++k) {
    hips += 0.5 * points_.Evaluate(kinematics_, landmarks.points[k], derivatives);
    if (!derivatives) continue;
    FillPointRows(layout, J_.middleRows(row_, 3));  // scratch until the first landmark
    hip_rows_ += 0.5 * J_.middleRows(row_, 3);
  }
  for (const LiftedPose::Point& point : lifted.points) {
    const Vector3d x = points_.Evaluate(kinematics_, landmarks.points[point.landmark], derivatives);
    const Vector3d residual = point.whitening * (x - hips - point.offset);
    const RobustValue robust = GemanMcClure(residual.squaredNorm(), data.lifted_kernel);
    cost_ += 0.5 * data.lifted_weight * robust.rho;
    if (!derivatives) continue;
    const double scale = std::sqrt(data.lifted_weight * robust.weight);
    FillPointRows(layout, J_.middleRows(row_, 3));
    const RowMatrixXd difference = J_.middleRows(row_, 3) - hip_rows_;
    J_.middleRows(row_, 3).noalias() = scale * point.whitening * difference;
    r_.segment<3>(row_) = scale * residual;
    row_ += 3;
  }
}

}  // namespace bodyloom
