// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/part_labels/part_labels.h"

#include <cmath>

#include "geometry/base/parallel.h"
#include "geometry/base/percentile.h"
#include "tracking/problem/moving_camera.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"

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

std::vector<PlanEntry> PlanPartLabels(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  const std::string no_silhouette = WhyNoSilhouette(input, options), no_parts = WhyNoParts(input, options);
  return {{"silhouette", no_silhouette.empty(), no_silhouette.empty() ? "of all labelled parts" : no_silhouette},
          {"part labels", no_parts.empty(), no_parts.empty() ? "outline and pixels of each part" : no_parts}};
}

std::unique_ptr<ClipTerm> MakePartLabelRounds(const ClipTermInput& clip) {
  if (!WhyNoSilhouette(clip.input, clip.options).empty() && !WhyNoParts(clip.input, clip.options).empty()) {
    return nullptr;
  }
  return std::make_unique<PartLabelRounds>(clip);
}

PartLabelRounds::PartLabelRounds(const ClipTermInput& clip)
    : labels_(*clip.input.part_labels),
      options_(clip.options.part_labels),
      skinner_(std::make_shared<const Skinner>(*clip.layout.model)),
      num_threads_(clip.num_threads),
      stature_m_(clip.stature_m),
      is_thinned_(IsMask(labels_) && clip.input.keypoints != nullptr),
      part_labels_(size_t(labels_.num_frames())) {}

std::vector<char> PartLabelRounds::SparseFrames() const {
  if (!is_thinned_) return {};
  std::vector<char> labelled;
  for (const PackedLabels& frame : labels_.frames) labelled.push_back(frame.empty() ? 0 : 1);
  return labelled;
}

void PartLabelRounds::SelectFrames(const std::vector<int>& coarse_frames) {
  is_used_.assign(part_labels_.size(), is_thinned_ ? 0 : 1);
  if (!is_thinned_) return;
  std::vector<double> steps;
  int last = -1;
  for (const int t : coarse_frames) {
    if (labels_.frames[size_t(t)].empty()) continue;
    is_used_[size_t(t)] = 1;
    if (last >= 0) steps.push_back(t - last);
    last = t;
  }
  if (!steps.empty()) weight_ = Percentile(steps, 50);
}

void PartLabelRounds::Observe(SequenceProblem* problem) {
  for (FrameData& frame : problem->frames) {
    frame.Get<SilhouetteTerm>();
    frame.Get<PartLabelTerm>();
  }
}

void PartLabelRounds::StartRound(int round, const std::vector<int>& frames, SequenceProblem* problem) {
  if (is_used_.empty()) SelectFrames(frames);
  const double s = options_.rounds > 1 ? static_cast<double>(round) / (options_.rounds - 1) : 1.0;
  const double kernel = options_.start_kernel * std::pow(options_.kernel / options_.start_kernel, s);
  ParallelFor(static_cast<int>(frames.size()), num_threads_, [&](int i) {
    const auto t = size_t(frames[i]);
    if (is_used_[t] == 0) return;
    if (part_labels_[t] == nullptr) {
      part_labels_[t] = std::make_unique<PartLabelMatches>(labels_, frames[i], skinner_, options_);
    }
    thread_local VisibleSurface surface;
    PartLabelMatches& matches = *part_labels_[t];
    const FrameState state = StateInCamera(*problem, i);
    const double height_px = UprightHeightPx(problem->layout, state, stature_m_);
    matches.Correspond(problem->layout, state, problem->betas, problem->log_focal, height_px, kernel, weight_,
                       &surface);
    problem->frames[i].Get<SilhouetteTerm>().matches = &matches;
    problem->frames[i].Get<PartLabelTerm>().matches = &matches;
  });
}

}  // namespace bodyloom
