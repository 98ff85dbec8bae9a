// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/upright.h"

#include <cmath>

#include "geometry/math/rotation.h"
#include "tracking/initialise/initial_states.h"
#include "tracking/problem/clip_term.h"
#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void UprightTerm::Add(FrameAccumulator* sums) const {
  if (!(weight > 0) || sums->layout().column_of_joint[0] < 0) return;
  const Matrix3d& root = sums->state().rotations[0];
  const double r = normal.dot(root.col(1)) / kUprightSigma;
  const double scale = sums->AddGroup(1, r * r, kUprightKernel, weight);
  if (!sums->derivatives()) return;
  const Eigen::RowVector3d row = -scale / kUprightSigma * normal.transpose() * root * Skew(Vector3d::UnitY());
  sums->AddBlockRows<1>(sums->layout().column_of_joint[0], row, Eigen::Matrix<double, 1, 1>(scale * r));
}

std::string WhyNoUp(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  const std::string no_lifter = WhyNotLifted(input, options);
  if (!no_lifter.empty()) return "the lifter says which way is up, and " + no_lifter;
  return options.ground.use_up ? "" : "switched off";
}

std::vector<PlanEntry> PlanUpright(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  const std::string why_not = WhyNoUp(input, options);
  return {{"vertical", why_not.empty(), why_not.empty() ? "the trunk's lean is measured against it" : why_not}};
}

std::unique_ptr<ClipTerm> MakeUprightTerms(const ClipTermInput& clip) {
  return EachFrame([weight = clip.options.upright_weight](int, const FrameState&, FrameData* frame) {
    frame->Get<UprightTerm>().weight = weight;
  });
}

}  // namespace bodyloom
