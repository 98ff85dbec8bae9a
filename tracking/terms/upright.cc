// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/terms/upright.h"

#include <cmath>

#include "bodyloom/geometry/rotation.h"
#include "bodyloom/tracking/frame_accumulator.h"
#include "bodyloom/tracking/initialise/initial_states.h"
#include "bodyloom/tracking/robust.h"
#include "bodyloom/tracking/track_options.h"
#include "bodyloom/tracking/track_summary.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void UprightOfFrame::Add(FrameAccumulator* sums) const {
  if (!(weight > 0) || sums->layout().column_of_joint[0] < 0) return;
  const Matrix3d& root = sums->state().rotations[0];
  const double r = normal.dot(root.col(1)) / kUprightSigma;
  const RobustValue robust = GemanMcClure(r * r, kUprightKernel);
  sums->AddCost(0.5 * weight * robust.rho);
  if (sums->derivatives()) {
    const double scale = std::sqrt(weight * robust.weight);
    const Eigen::RowVector3d row = -scale / kUprightSigma * normal.transpose() * root * Skew(Vector3d::UnitY());
    sums->AddSquares(sums->layout().column_of_joint[0], row.transpose() * row, row.transpose() * (scale * r));
  }
}

std::string WhyNoUp(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  const std::string no_lifter = WhyNotLifted(input, options);
  if (!no_lifter.empty()) return "the lifter says which way is up, and " + no_lifter;
  return options.ground.use_up ? "" : "switched off";
}

PlanEntry PlanUp(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  const std::string why_not = WhyNoUp(input, options);
  return {"vertical", why_not.empty(), why_not.empty() ? "the trunk's lean is measured against it" : why_not};
}

}  // namespace bodyloom
