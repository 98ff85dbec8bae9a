// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/initialiser.h"

#include <cmath>

#include "geometry/base/check.h"
#include "geometry/math/rotation.h"
#include "tracking/problem/clip_term.h"
#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void InitialiserTerm::Add(FrameAccumulator* sums) const {
  if (!runs()) return;
  // ½ s² ‖e‖² of one block of three unknowns by which e has the derivative d.
  const auto add = [&](int column, double s, const Vector3d& e, const Matrix3d& d) {
    sums->AddGroup(3, s * s * e.squaredNorm(), 0, 1);
    if (!sums->derivatives()) return;
    const Matrix3d J = s * d;
    if (sums->one_by_one()) {
      sums->AddBlockRows<3>(column, J, s * e);
      return;
    }
    sums->H().block<3, 3>(column, column) += J.transpose() * J;
    sums->gradient().segment<3>(column) += s * (J.transpose() * e);
  };
  for (int j : sums->layout().active_joints) {
    const Vector3d w = AxisAngleFromRotation(rotations[j].transpose() * sums->state().rotations[j]);
    add(sums->layout().column_of_joint[j], std::sqrt(weight) / sigma, w,
        sums->derivatives() ? RightJacobianInverse(w) : Matrix3d());
  }
  const double s = std::sqrt(weight) / translation_sigma;
  const Vector3d offset = sums->state().translation - translation;
  add(sums->layout().translation_column, s, offset, Matrix3d::Identity());
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
