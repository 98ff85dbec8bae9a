// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/part_labels/part_labels.h"

#include <algorithm>
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

std::shared_ptr<PartLabelMatches> KeptMatches::Find(const std::shared_ptr<PartLabelMatches>& slot) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return slot;
}

std::vector<std::shared_ptr<PartLabelMatches>> KeptMatches::Forget() {
  std::vector<std::shared_ptr<PartLabelMatches>> surplus;
  for (; slots_.size() > capacity_; slots_.pop_front()) {
    surplus.push_back(std::move(*slots_.front()));
    slots_.front()->reset();
  }
  return surplus;
}

void KeptMatches::SetCapacity(size_t capacity) {
  std::vector<std::shared_ptr<PartLabelMatches>> surplus;
  const std::lock_guard<std::mutex> lock(mutex_);
  capacity_ = capacity;
  surplus = Forget();
}

void KeptMatches::Add(std::shared_ptr<PartLabelMatches> matches, std::shared_ptr<PartLabelMatches>* slot) {
  std::vector<std::shared_ptr<PartLabelMatches>> surplus;
  const std::lock_guard<std::mutex> lock(mutex_);
  *slot = std::move(matches);
  slots_.push_back(slot);
  surplus = Forget();
}

void LabelledFrame::Correspond(const FrameLayout& layout, PartLabelMatches* matches) const {
  thread_local VisibleSurface surface;
  matches->Correspond(layout, round_.state, round_.betas, round_.log_focal, round_.person_height_px, round_.kernel,
                      round_.weight, &surface);
  num_rows_ = {matches->num_rows(false), matches->num_rows(true)};
  num_person_pixels_ = matches->num_person_pixels();
}

std::shared_ptr<const PartLabelMatches> LabelledFrame::Get(const FrameLayout& layout) const {
  if (std::shared_ptr<PartLabelMatches> known = kept_.Find(matches_); known != nullptr) return known;
  auto matches = std::make_shared<PartLabelMatches>(labels_, t_, skinner_, options_);
  Correspond(layout, matches.get());
  kept_.Add(matches, &matches_);
  return matches;
}

void LabelledFrame::StartRound(const FrameLayout& layout, Round round, bool later) {
  round_ = std::move(round);
  if (const std::shared_ptr<PartLabelMatches> known = kept_.Find(matches_); known != nullptr) {
    Correspond(layout, known.get());
  } else if (later) {
    num_rows_ = {0, PartLabelMatches::MaxMaskRows()};
    num_person_pixels_ = 1;
  } else {
    Get(layout);
  }
}

PartLabelRounds::PartLabelRounds(const ClipTermInput& clip, size_t max_kept)
    : labels_(*clip.input.part_labels),
      options_(clip.options.part_labels),
      skinner_(std::make_shared<const Skinner>(*clip.layout.model)),
      num_threads_(clip.num_threads),
      stature_m_(clip.stature_m),
      is_thinned_(IsMask(labels_) && clip.input.keypoints != nullptr),
      max_kept_(max_kept),
      kept_(size_t(labels_.num_frames())),
      frames_(size_t(labels_.num_frames())) {}

std::vector<char> PartLabelRounds::SparseFrames() const {
  if (!is_thinned_) return {};
  std::vector<char> labelled;
  for (const PackedLabels& frame : labels_.frames) labelled.push_back(frame.empty() ? 0 : 1);
  return labelled;
}

void PartLabelRounds::BeginRounds(const std::vector<int>& coarse_frames, bool in_windows) {
  later_ = is_thinned_ && in_windows;
  is_used_.assign(frames_.size(), is_thinned_ ? 0 : 1);
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

size_t PartLabelRounds::MostUsedInWindow(const std::vector<int>& frames) const {
  const size_t window = max_kept_ - max_kept_ / 11;  // of the solve: all but the tenth on top of it
  size_t used = 0, most = 0;
  for (size_t i = 0; i < frames.size(); ++i) {
    used += is_used_[size_t(frames[i])] != 0 ? 1 : 0;
    if (i >= window) used -= is_used_[size_t(frames[i - window])] != 0 ? 1 : 0;
    most = std::max(most, used);
  }
  return most;
}

void PartLabelRounds::StartRound(int round, const std::vector<int>& frames, SequenceProblem* problem) {
  if (is_used_.empty()) BeginRounds(frames, false);
  const double s = options_.rounds > 1 ? static_cast<double>(round) / (options_.rounds - 1) : 1.0;
  const double kernel = options_.start_kernel * std::pow(options_.kernel / options_.start_kernel, s);
  if (later_) {
    const size_t most = MostUsedInWindow(frames);
    kept_.SetCapacity(std::min(max_kept_, most + most / 10 + 1));
  }
  ParallelFor(static_cast<int>(frames.size()), num_threads_, [&](int i) {
    const auto t = size_t(frames[i]);
    if (is_used_[t] == 0) return;
    if (frames_[t] == nullptr) {
      frames_[t] = std::make_unique<LabelledFrame>(labels_, frames[i], skinner_, options_, &kept_);
    }
    LabelledFrame::Round start{.state = StateInCamera(*problem, i),
                               .betas = problem->betas,
                               .log_focal = problem->log_focal,
                               .kernel = kernel,
                               .weight = weight_};
    start.person_height_px = UprightHeightPx(problem->layout, start.state, stature_m_);
    frames_[t]->StartRound(problem->layout, std::move(start), later_);
    problem->frames[i].Get<SilhouetteTerm>().matches = frames_[t].get();
    problem->frames[i].Get<PartLabelTerm>().matches = frames_[t].get();
  });
}

}  // namespace bodyloom
