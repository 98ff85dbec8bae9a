// SPDX-License-Identifier: Apache-2.0
/// The problem that TrackSequence() solves, as a ceres::Problem to inspect, change and solve.
#pragma once

#include <memory>

#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"
#include "tracking/solvers/ceres_problem.h"

namespace bodyloom {

class ClipFit;

class ClipCeresProblem {
 public:
  /// As BuildCeresProblem(), but without its checks of input and options.
  ClipCeresProblem(const TrackSequenceInput& input, const TrackSequenceOptions& options);
  ~ClipCeresProblem();
  ClipCeresProblem(const ClipCeresProblem&) = delete;
  ClipCeresProblem& operator=(const ClipCeresProblem&) = delete;

  /// Null when no frame shows enough of the body to start from; the summary says so.
  [[nodiscard]] CeresProblem* blocks() { return blocks_.get(); }
  /// Summary of the stages so far.
  [[nodiscard]] const TrackSequenceSummary& summary() const { return result_.summary; }
  /// The result of TrackSequence() at the parameters' current values. To be called once.
  TrackSequenceResult Finish();

 private:
  TrackSequenceOptions options_;
  TrackSequenceResult result_;
  std::unique_ptr<ClipFit> fit_;
  std::unique_ptr<CeresProblem> blocks_;
};

/// Builds the problem of a clip as TrackSequence() passes it to Ceres: all terms of all frames, at the parameter values
/// after the earlier stages (SequenceSolver::kChainThenCeres). What `input` points to must outlive the result; defaults
/// and exceptions are those of TrackSequence(). Every observation is a residual block with a loss function of its own.
std::unique_ptr<ClipCeresProblem> BuildCeresProblem(const TrackSequenceInput& input,
                                                    const TrackSequenceOptions& options = {});

}  // namespace bodyloom
