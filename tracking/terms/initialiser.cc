// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/terms/initialiser.h"

#include <cmath>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/rotation.h"
#include "bodyloom/tracking/frame_accumulator.h"
#include "bodyloom/tracking/problem/clip_term.h"
#include "bodyloom/tracking/track_input.h"
#include "bodyloom/tracking/track_options.h"
#include "bodyloom/tracking/track_summary.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void InitialiserTerm::Add(FrameAccumulator* sums) const {
  if (!runs()) return;
  const double rotation_scale = std::sqrt(weight) / sigma;
  for (int j : sums->layout().active_joints) {
    const Vector3d w = AxisAngleFromRotation(rotations[j].transpose() * sums->state().rotations[j]);
    sums->AddGroup(3, rotation_scale * rotation_scale * w.squaredNorm(), 0, 1);
    if (!sums->derivatives()) continue;
    sums->AddBlockRows<3>(sums->layout().column_of_joint[j], rotation_scale * RightJacobianInverse(w),
                          rotation_scale * w);
  }
  const double translation_scale = std::sqrt(weight) / translation_sigma;
  const Vector3d offset = sums->state().translation - translation;
  sums->AddGroup(3, translation_scale * translation_scale * offset.squaredNorm(), 0, 1);
  if (!sums->derivatives()) return;
  sums->AddBlockRows<3>(sums->layout().translation_column, translation_scale * Matrix3d::Identity(),
                        translation_scale * offset);
}

std::vector<PlanEntry> PlanInitialiser(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  if (input.initialiser == nullptr) return {};
  return {
      {"initialiser term (L_d)", options.initialiser_weight > 0, Concatenate("weight ", options.initialiser_weight)}};
}

std::unique_ptr<ClipTerm> MakeInitialiserTerms(const ClipTermInput& clip) {
  return EachFrame([given = clip.input.initialiser](int t, const FrameState& state, FrameData* frame) {
    InitialiserTerm& term = frame->Get<InitialiserTerm>();
    if (given != nullptr && !given->HasPose(t)) return;
    term.rotations = state.rotations;
    term.translation = state.translation;
  });
}

}  // namespace bodyloom
