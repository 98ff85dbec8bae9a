// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/terms/initialiser.h"

#include <cmath>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/rotation.h"
#include "bodyloom/tracking/frame_accumulator.h"
#include "bodyloom/tracking/initialise/initial_states.h"
#include "bodyloom/tracking/track_options.h"
#include "bodyloom/tracking/track_summary.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void InitialiserOfFrame::Add(FrameAccumulator* sums) const {
  if (rotations.empty() || !(weight > 0)) return;
  const double rotation_scale = std::sqrt(weight) / sigma;
  for (int j : sums->layout().active_joints) {
    const Vector3d w = AxisAngleFromRotation(rotations[j].transpose() * sums->state().rotations[j]);
    sums->AddCost(0.5 * rotation_scale * rotation_scale * w.squaredNorm());
    if (!sums->derivatives()) continue;
    const Matrix3d d_w = rotation_scale * RightJacobianInverse(w);
    sums->AddSquares(sums->layout().column_of_joint[j], d_w.transpose() * d_w, rotation_scale * (d_w.transpose() * w));
  }
  const double translation_scale = std::sqrt(weight) / translation_sigma;
  const Vector3d offset = sums->state().translation - translation;
  sums->AddCost(0.5 * translation_scale * translation_scale * offset.squaredNorm());
  if (sums->derivatives()) {
    const double information = translation_scale * translation_scale;
    sums->AddSquares(sums->layout().translation_column, information * Matrix3d::Identity(), information * offset);
  }
}

PlanEntry PlanInitialiser(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  const bool given = input.initialiser != nullptr;
  const bool stays = given ? options.initialiser_weight > 0 : WhyNoLifter(input, options).empty();
  return {"initialiser term (L_d)", stays,
          stays ? Concatenate("weight ", given ? options.initialiser_weight : options.lifter_weight,
                              given ? "" : ", of the lifter")
                : "no initialiser and no lifter"};
}

}  // namespace bodyloom
