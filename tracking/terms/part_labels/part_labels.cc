// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/terms/part_labels/part_labels.h"

#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/tracking/initialise/stature.h"
#include "bodyloom/tracking/moving_camera.h"
#include "bodyloom/tracking/track_input.h"
#include "bodyloom/tracking/track_options.h"
#include "bodyloom/tracking/track_summary.h"

namespace bodyloom {

std::string WhyNoSilhouette(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  if (input.part_labels == nullptr) return "no part labels or masks in the input";
  return options.part_labels.silhouette_weight == 0 ? "switched off" : "";
}

std::string WhyNoParts(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  if (input.part_labels == nullptr) return "no part labels in the input";
  if (!input.body->has_parts()) return "the body has no charts";
  return options.part_labels.part_weight == 0 ? "switched off" : "";
}

PlanEntry PlanSilhouette(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  const std::string why_not = WhyNoSilhouette(input, options);
  return {"silhouette", why_not.empty(), why_not.empty() ? "of all labelled parts" : why_not};
}

PlanEntry PlanParts(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  const std::string why_not = WhyNoParts(input, options);
  return {"part labels", why_not.empty(), why_not.empty() ? "outline and pixels of each part" : why_not};
}

PartLabelRounds::PartLabelRounds(const TrackSequenceInput& input, const TrackSequenceOptions& options,
                                 const FrameLayout& layout, int num_threads)
    : num_threads_(num_threads), stature_m_(AssumedStature(input)) {
  if (!WhyNoSilhouette(input, options).empty() && !WhyNoParts(input, options).empty()) return;
  const auto skinner = std::make_shared<const Skinner>(*layout.model);
  part_labels_.resize(input.part_labels->num_frames());
  ParallelFor(input.part_labels->num_frames(), num_threads, [&](int t) {
    part_labels_[t] = std::make_unique<PartLabelTerm>(*input.part_labels, t, skinner, options.part_labels);
  });
}

void PartLabelRounds::Start(const std::vector<int>& frames, double kernel, SequenceProblem* problem) const {
  if (!any()) return;
  ParallelFor(static_cast<int>(frames.size()), num_threads_, [&](int i) {
    thread_local VisibleSurface surface;
    PartLabelTerm& term = *part_labels_[frames[i]];
    const FrameState state = StateInCamera(*problem, i);
    const double height_px = UprightHeightPx(problem->layout, state, stature_m_);
    term.Correspond(problem->layout, state, problem->betas, problem->log_focal, height_px, kernel, &surface);
    problem->frames[i].part_labels.term = &term;
  });
}

}  // namespace bodyloom
