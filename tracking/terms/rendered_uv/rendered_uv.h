// SPDX-License-Identifier: Apache-2.0
/// L_r of paper A over a clip: dense keypoints with residuals in UV (formula: rendered_uv_term.h), and the rounds in
/// which their covariance is computed.
///
/// The covariance of an error is computed at the start of a round and fixed during its solve; the visible faces are
/// found at every state. Runs when the keypoints' noise is known to be on the surface (or when RenderedUvOptions does
/// not require that), and the body has charts. Keypoints that it uses are excluded from the dense term.
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

/// The reason why the term does not run; empty if it does.
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
  std::shared_ptr<const Skinner> skinner_;                      ///< null if the surface is not needed
  std::vector<std::unique_ptr<RenderedUvPixels>> rendered_uv_;  ///< T, or empty
};

}  // namespace bodyloom
