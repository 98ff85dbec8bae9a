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

#include "tracking/problem/clip_term.h"
#include "tracking/terms/rendered_uv/rendered_uv_term.h"

namespace bodyloom {

struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

/// Why the term does not run, or empty when it does.
std::string WhyNoRenderedUv(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::vector<PlanEntry> PlanRenderedUv(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::unique_ptr<ClipTerm> MakeDenseRounds(const ClipTermInput& clip);

/// The rounds of a clip with dense keypoints: their covariance and, where it runs, the rendered UV.
class DenseRounds : public ClipTerm {
 public:
  explicit DenseRounds(const ClipTermInput& clip);

  void Observe(SequenceProblem* problem) override;
  [[nodiscard]] Rounds rounds() const override { return rounds_; }
  void StartRound(int round, const std::vector<int>& frames, SequenceProblem* problem) override;

 private:
  const TrackSequenceInput& input_;
  int num_threads_;
  Rounds rounds_;
  std::shared_ptr<const Skinner> skinner_;                      ///< null when nothing looks at the surface
  std::vector<std::unique_ptr<RenderedUvPixels>> rendered_uv_;  ///< T, or empty
};

}  // namespace bodyloom
