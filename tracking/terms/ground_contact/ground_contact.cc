// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/ground_contact/ground_contact.h"

#include <cmath>

#include "tracking/initialise/initial_states.h"
#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/robust.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void GroundContactTerm::Add(FrameAccumulator* sums) const {
  if (feet.empty()) return;
  const FrameLayout& layout = sums->layout();
  // Except for weak perspective the kinematics include the translation.
  const bool weak = layout.knowledge == CameraKnowledge::kWeak;
  const Vector3d offset = weak ? layout.BodyPlace(sums->state()) : Vector3d::Zero();
  const Matrix3d d_place = layout.BodyPlaceByTranslation(sums->state());
  for (const GroundContact& contact : feet) {
    const Vector3d x = sums->points().Evaluate(sums->kinematics(), *contact.point, sums->derivatives()) + offset;
    const Vector3d residual = contact.whitening * (x - contact.target_m);
    const double scale = sums->AddGroup(3, residual.squaredNorm(), kContactKernel, 1);
    if (!sums->derivatives()) continue;
    auto rows = sums->NextRows(3);
    sums->FillPointRows(rows);
    rows.middleCols<3>(layout.translation_column) = d_place;
    const RowMatrixXd d_x = rows;
    rows.noalias() = scale * contact.whitening * d_x;
    sums->NextResiduals(3) = scale * residual;
    sums->TakeRows(3);
    sums->DependsOnPoint();
    sums->DependsOn(layout.TranslationBlock());
  }
}

std::string WhyNoGround(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  const std::string no_lifter = WhyNotLifted(input, options);
  if (!no_lifter.empty()) return "the lifter says which feet stand, and " + no_lifter;
  return options.ground.contact_weight > 0 ? "" : "switched off";
}

std::vector<PlanEntry> PlanGround(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  const std::string why_not = WhyNoGround(input, options);
  return {{"ground", why_not.empty(),
           why_not.empty() ? "looked for; standing feet are held to it when there is one" : why_not}};
}

}  // namespace bodyloom
