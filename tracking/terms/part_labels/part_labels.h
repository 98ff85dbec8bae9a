// SPDX-License-Identifier: Apache-2.0
/// The terms of silhouette and part labels over a clip (residuals: part_label_term.h), and the rounds in which their
/// correspondences are found.
///
/// Correspondences are found at the start of a round and fixed during its solve; the kernel narrows from round to round
/// (PartLabelOptions::start_kernel to kernel). Runs when the input has labels or masks; parts only for a body with
/// charts.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tracking/problem/clip_term.h"
#include "tracking/terms/part_labels/part_label_term.h"

namespace bodyloom {

struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

/// The reason why a term does not run; empty if it does.
std::string WhyNoSilhouette(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::string WhyNoParts(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::vector<PlanEntry> PlanPartLabels(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::unique_ptr<ClipTerm> MakePartLabelRounds(const ClipTermInput& clip);

class PartLabelRounds : public ClipTerm {
 public:
  explicit PartLabelRounds(const ClipTermInput& clip);

  void Observe(SequenceProblem* problem) override;
  [[nodiscard]] Rounds rounds() const override { return {options_.rounds, options_.max_iterations, "fit part labels"}; }
  void StartRound(int round, const std::vector<int>& frames, SequenceProblem* problem) override;

 private:
  PartLabelOptions options_;
  int num_threads_;
  double stature_m_;
  std::vector<std::unique_ptr<PartLabelMatches>> part_labels_;  ///< T
};

}  // namespace bodyloom
