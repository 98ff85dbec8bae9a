// SPDX-License-Identifier: Apache-2.0
// Standing feet in FrameEvaluator (residuals/ground_contact.h).
#include <cmath>

#include "bodyloom/tracking/frame_cost.h"
#include "bodyloom/tracking/robust.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void FrameEvaluator::AddContacts(const FrameLayout& layout, const FrameData& data, const FrameState& state,
                                 bool derivatives) {
  const bool weak = layout.knowledge == CameraKnowledge::kWeak;
  const Vector3d origin = layout.BodyPlace(state);
  const Vector3d offset = weak ? origin : Vector3d::Zero();  // elsewhere the kinematics have the translation
  Matrix3d d_origin = Matrix3d::Identity();
  if (weak) {
    d_origin.col(0) = -origin.z() * Vector3d::UnitZ();
    d_origin.col(1) = Vector3d::UnitX();
    d_origin.col(2) = Vector3d::UnitY();
  }
  for (const GroundContact& contact : data.contacts) {
    const Vector3d x = points_.Evaluate(kinematics_, *contact.point, derivatives) + offset;
    const Vector3d residual = contact.whitening * (x - contact.target_m);
    const RobustValue robust = GemanMcClure(residual.squaredNorm(), kContactKernel);
    cost_ += 0.5 * robust.rho;
    if (!derivatives) continue;
    const double scale = std::sqrt(robust.weight);
    auto rows = J_.middleRows(row_, 3);
    FillPointRows(layout, rows);
    rows.middleCols<3>(layout.translation_column) = d_origin;
    const RowMatrixXd d_x = rows;
    rows.noalias() = scale * contact.whitening * d_x;
    r_.segment<3>(row_) = scale * residual;
    row_ += 3;
  }
}

}  // namespace bodyloom
