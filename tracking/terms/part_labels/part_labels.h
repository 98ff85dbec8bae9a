// SPDX-License-Identifier: Apache-2.0
/// The terms of silhouette and part labels over a clip (residuals: part_label_term.h), and the rounds in which their
/// correspondences are found.
///
/// Correspondences are found at the start of a round and fixed during its solve; the kernel narrows from round to round
/// (PartLabelOptions::start_kernel to kernel). Runs when the input has labels or masks; parts only for a body with
/// charts.
///
/// Masks beside 2D joints are used in the coarse frames only, as outlines of frames that are closer say the same
/// (docs/lab/run_speed.md); each counts for all the frames from one to the next.
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
  [[nodiscard]] std::vector<char> SparseFrames() const override;
  [[nodiscard]] Rounds rounds() const override { return {options_.rounds, options_.max_iterations, "fit part labels"}; }
  void StartRound(int round, const std::vector<int>& frames, SequenceProblem* problem) override;

 private:
  /// Selects the frames whose labels are used, and their weight.
  void SelectFrames(const std::vector<int>& coarse_frames);

  const PartLabelSequence& labels_;
  PartLabelOptions options_;
  std::shared_ptr<const Skinner> skinner_;
  int num_threads_;
  double stature_m_;
  bool is_thinned_;            ///< the coarse frames only
  std::vector<char> is_used_;  ///< T; empty before the first round
  double weight_ = 1;
  std::vector<std::unique_ptr<PartLabelMatches>> part_labels_;  ///< T; null in frames that are not used
};

}  // namespace bodyloom
