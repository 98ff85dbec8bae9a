// SPDX-License-Identifier: Apache-2.0
/// The problem that TrackSequence() solves, as a ceres::Problem to look into, change and solve.
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
  /// As BuildCeresProblem(), which checks what it is given.
  ClipCeresProblem(const TrackSequenceInput& input, const TrackSequenceOptions& options);
  ~ClipCeresProblem();
  ClipCeresProblem(const ClipCeresProblem&) = delete;
  ClipCeresProblem& operator=(const ClipCeresProblem&) = delete;

  /// Null when no frame shows enough of the body to start from; the summary says so.
  [[nodiscard]] CeresProblem* blocks() { return blocks_.get(); }
  /// What ran so far.
  [[nodiscard]] const TrackSequenceSummary& summary() const { return result_.summary; }
  /// The track at the parameters' values, with all that TrackSequence() gives beside it. Once.
  TrackSequenceResult Finish();

 private:
  TrackSequenceOptions options_;
  TrackSequenceResult result_;
  std::unique_ptr<ClipFit> fit_;
  std::unique_ptr<CeresProblem> blocks_;
};

/// States the problem of a clip as TrackSequence() hands it to Ceres: all terms of all frames, at the values to which
/// the stages before have brought them (SequenceSolver::kChainThenCeres). What `input`
/// points to is borrowed for the life of the result; defaults are filled in and it throws as TrackSequence() does.
/// Every observation is a residual block with a loss function of its own.
std::unique_ptr<ClipCeresProblem> BuildCeresProblem(const TrackSequenceInput& input,
                                                    const TrackSequenceOptions& options = {});

}  // namespace bodyloom
