// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/terms/pose_prior/pose_prior.h"

#include <vector>

#include "bodyloom/geometry/rotation.h"
#include "bodyloom/tracking/frame_accumulator.h"
#include "bodyloom/tracking/track_input.h"
#include "bodyloom/tracking/track_summary.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::VectorXd;

void PosePriorOfFrame::Add(FrameAccumulator* sums) const {
  if (mixture == nullptr || mixture->empty() || !(weight > 0)) return;
  const FrameLayout& layout = sums->layout();
  const std::vector<int>& joints = mixture->joints();
  VectorXd x(3 * joints.size());
  for (size_t i = 0; i < joints.size(); ++i)
    x.segment<3>(3 * i) = AxisAngleFromRotation(sums->state().rotations[joints[i]]);
  double energy;
  const int k = mixture->Nearest(x, &energy);
  sums->AddCost(0.5 * weight * energy);
  if (!sums->derivatives()) return;
  const Eigen::MatrixXd& precision = mixture->precision(k);
  std::vector<Matrix3d> d_x(joints.size());
  for (size_t i = 0; i < joints.size(); ++i) d_x[i] = RightJacobianInverse(x.segment<3>(3 * i));
  const VectorXd force = weight * (precision * (x - mixture->mean(k)));
  for (size_t i = 0; i < joints.size(); ++i) {
    const int row = layout.column_of_joint[joints[i]];
    sums->gradient().segment<3>(row) += d_x[i].transpose() * force.segment<3>(3 * i);
    for (size_t j = 0; j < joints.size(); ++j) {
      const int column = layout.column_of_joint[joints[j]];
      if (column < row) continue;
      const Matrix3d half = weight * d_x[i].transpose() * precision.block<3, 3>(3 * i, 3 * j);
      sums->H().block<3, 3>(row, column) += half * d_x[j];
    }
  }
}

PlanEntry PlanPosePrior(const TrackSequenceInput& input, const TrackSequenceOptions& /*options*/) {
  return {"pose prior", input.prior != nullptr, input.prior != nullptr ? "learned mixture" : "none was given"};
}

}  // namespace bodyloom
