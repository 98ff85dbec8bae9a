// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/straight_knees.h"

#include <cmath>

#include "geometry/base/check.h"
#include "geometry/math/rotation.h"
#include "tracking/problem/clip_term.h"
#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

using Eigen::Vector3d;

std::array<int, 2> FindKnees(const BodyModel& model) { return {model.FindJoint("l_knee"), model.FindJoint("r_knee")}; }

void StraightKneesTerm::Add(FrameAccumulator* sums) const {
  if (!(weight > 0)) return;
  for (const int knee : knees) {
    if (knee < 0 || sums->layout().column_of_joint[knee] < 0) continue;
    const Vector3d w = AxisAngleFromRotation(sums->state().rotations[knee]);
    const double flexion = w.x();
    const double scale = sums->AddGroup(1, flexion * flexion, kStraightKneesKernel, weight * weight);
    if (!sums->derivatives()) continue;
    const Eigen::RowVector3d row = scale * RightJacobianInverse(w).row(0);
    sums->AddBlockRows<1>(sums->layout().column_of_joint[knee], row, Eigen::Matrix<double, 1, 1>(scale * flexion));
  }
}

std::vector<PlanEntry> PlanStraightKnees(const TrackSequenceInput& /*input*/, const TrackSequenceOptions& options) {
  if (!(options.straight_knees_weight > 0)) return {};
  return {{"straight knees", true, Concatenate("both, with weight ", options.straight_knees_weight)}};
}

std::unique_ptr<ClipTerm> MakeStraightKneesTerms(const ClipTermInput& clip) {
  if (!(clip.options.straight_knees_weight > 0)) return nullptr;
  const StraightKneesTerm term(FindKnees(*clip.layout.model), clip.options.straight_knees_weight);
  return EachFrame([term](int, const FrameState&, FrameData* frame) { frame->Get<StraightKneesTerm>() = term; });
}

}  // namespace bodyloom
