// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/terms/straight_knees.h"

#include <cmath>
#include <cstdio>

#include "bodyloom/geometry/rotation.h"
#include "bodyloom/tracking/frame_accumulator.h"
#include "bodyloom/tracking/robust.h"
#include "bodyloom/tracking/track_summary.h"

namespace bodyloom {

using Eigen::Vector3d;

std::array<int, 2> FindKnees(const BodyModel& model) { return {model.FindJoint("l_knee"), model.FindJoint("r_knee")}; }

void StraightKneesOfFrame::Add(FrameAccumulator* sums) const {
  if (!(weight > 0)) return;
  for (const int knee : knees) {
    if (knee < 0 || sums->layout().column_of_joint[knee] < 0) continue;
    const Vector3d w = AxisAngleFromRotation(sums->state().rotations[knee]);
    const double flexion = w.x();
    const RobustValue robust = GemanMcClure(flexion * flexion, kStraightKneesKernel);
    sums->AddCost(0.5 * weight * weight * robust.rho);
    if (!sums->derivatives()) continue;
    const double scale = weight * std::sqrt(robust.weight);
    const Eigen::RowVector3d row = scale * RightJacobianInverse(w).row(0);
    sums->AddSquares(sums->layout().column_of_joint[knee], row.transpose() * row, row.transpose() * (scale * flexion));
  }
}

PlanEntry PlanStraightKnees(double weight) {
  char text[64];
  std::snprintf(text, sizeof(text), "both, with weight %g", weight);
  return {"straight knees", true, text};
}

}  // namespace bodyloom
