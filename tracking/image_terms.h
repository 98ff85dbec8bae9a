// SPDX-License-Identifier: Apache-2.0
/// The image terms of a clip that have rounds: dense keypoints with their covariance and in UV (L_r), outlines and part
/// labels. What corresponds to what, and which covariance an error has, is found at the start of a round and fixed
/// during its solve; only the rendered UV looks at the body anew at every state.
#pragma once

#include <memory>
#include <vector>

#include "bodyloom/tracking/residuals/part_label_term.h"
#include "bodyloom/tracking/residuals/rendered_uv_term.h"
#include "bodyloom/tracking/sequence_problem.h"
#include "bodyloom/tracking/track_sequence.h"

namespace bodyloom {

/// Why a term does not run, or empty when it does.
std::string WhyNoRenderedUv(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::string WhyNoSilhouette(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::string WhyNoParts(const TrackSequenceInput& input, const TrackSequenceOptions& options);

/// Image height of an upright body of this stature at a frame's depth, pixels: the yardstick of detection noise.
double PersonHeightPx(const FrameLayout& layout, const FrameState& state, double stature_m);

/// Must not outlive the input, the options and the layout's body.
class ImageTerms {
 public:
  ImageTerms(const TrackSequenceInput& input, const TrackSequenceOptions& options, const FrameLayout& layout,
             int num_threads);

  [[nodiscard]] bool has_dense_rounds() const { return !rendered_uv_.empty() || whitens_; }
  [[nodiscard]] bool has_part_labels() const { return !part_labels_.empty(); }

  /// Starts a round: `problem` holds the frames `frames` of the clip. Whitening and, where wanted, rendered UV.
  void StartDenseRound(const std::vector<int>& frames, SequenceProblem* problem) const;
  void StartPartLabelRound(const std::vector<int>& frames, double kernel, SequenceProblem* problem) const;

  /// Appends how well each term fits `problem`, which holds the whole clip.
  void Summarise(const SequenceProblem& problem, TrackSequenceSummary* summary) const;

 private:
  const TrackSequenceInput& input_;
  int num_threads_;
  bool whitens_ = false;
  double stature_m_ = 0;
  std::shared_ptr<const Skinner> skinner_;                    ///< null when no term looks at the surface
  std::vector<std::unique_ptr<RenderedUvTerm>> rendered_uv_;  ///< T, or empty
  std::vector<std::unique_ptr<PartLabelTerm>> part_labels_;   ///< T, or empty
};

}  // namespace bodyloom
