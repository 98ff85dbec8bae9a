// SPDX-License-Identifier: Apache-2.0
/// L_r of paper A in a frame and over a clip: dense keypoints whose residual is taken in UV (rendered_uv_term.h has the
/// law), and the rounds in which their covariance is found.
///
/// Which covariance an error has is found at the start of a round and fixed during its solve; the visible faces are
/// looked up at every state. Runs when the keypoints say that their noise lies on the surface (or when
/// RenderedUvOptions lets it run without), and the body has charts. Keypoints that it takes leave the dense term.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bodyloom/tracking/sequence_problem.h"
#include "bodyloom/tracking/terms/rendered_uv/rendered_uv_term.h"

namespace bodyloom {

struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

/// Why the term does not run, or empty when it does.
std::string WhyNoRenderedUv(const TrackSequenceInput& input, const TrackSequenceOptions& options);
PlanEntry PlanRenderedUv(const TrackSequenceInput& input, const TrackSequenceOptions& options);

/// The rounds of a clip with dense keypoints: their covariance and, where it runs, the rendered UV. Must not outlive
/// the input and the layout's body.
class DenseRounds {
 public:
  DenseRounds(const TrackSequenceInput& input, const TrackSequenceOptions& options, const FrameLayout& layout,
              int num_threads);

  [[nodiscard]] bool any() const { return has_rendered_uv() || whitens_; }
  [[nodiscard]] bool has_rendered_uv() const { return !rendered_uv_.empty(); }
  /// Starts a round: `problem` holds the frames `frames` of the clip. Nothing changes unless any().
  void Start(const std::vector<int>& frames, SequenceProblem* problem) const;

 private:
  const TrackSequenceInput& input_;
  int num_threads_;
  bool whitens_ = false;
  std::shared_ptr<const Skinner> skinner_;                    ///< null when nothing looks at the surface
  std::vector<std::unique_ptr<RenderedUvTerm>> rendered_uv_;  ///< T, or empty
};

}  // namespace bodyloom
