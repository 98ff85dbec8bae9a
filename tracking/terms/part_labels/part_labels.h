// SPDX-License-Identifier: Apache-2.0
/// The silhouette and the part labels in a frame and over a clip: contours that should coincide and pixels that should
/// be covered (part_label_term.h has the law), and the rounds in which they are matched.
///
/// What corresponds to what is found at the start of a round and fixed during its solve; the kernel narrows from round
/// to round (PartLabelOptions::start_kernel to kernel). Runs when the input has labels or masks; parts only for a body
/// with charts.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bodyloom/tracking/sequence_problem.h"
#include "bodyloom/tracking/terms/part_labels/part_label_term.h"

namespace bodyloom {

struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

/// Why a term does not run, or empty when it does.
std::string WhyNoSilhouette(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::string WhyNoParts(const TrackSequenceInput& input, const TrackSequenceOptions& options);
PlanEntry PlanSilhouette(const TrackSequenceInput& input, const TrackSequenceOptions& options);
PlanEntry PlanParts(const TrackSequenceInput& input, const TrackSequenceOptions& options);

/// Must not outlive the input and the layout's body.
class PartLabelRounds {
 public:
  PartLabelRounds(const TrackSequenceInput& input, const TrackSequenceOptions& options, const FrameLayout& layout,
                  int num_threads);

  [[nodiscard]] bool any() const { return !part_labels_.empty(); }
  /// Starts a round: `problem` holds the frames `frames` of the clip. Nothing changes unless any().
  void Start(const std::vector<int>& frames, double kernel, SequenceProblem* problem) const;

 private:
  int num_threads_;
  double stature_m_ = 0;
  std::vector<std::unique_ptr<PartLabelTerm>> part_labels_;  ///< T, or empty
};

}  // namespace bodyloom
