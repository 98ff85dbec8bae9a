// SPDX-License-Identifier: Apache-2.0
/// Table of the successive solves of TrackSequence().
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "geometry/base/stopwatch.h"
#include "tracking/problem/sequence_problem.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

struct Stage {
  const char* name;
  double pull;             ///< weight of the initialiser's term (terms/initialiser.h)
  double landmark_kernel;  ///< c of the 2D joints, in σ
  double tolerance;        ///< relative change of the cost that ends it
  int max_iterations;
  double from, to;          ///< of the whole run, for progress
  bool in_windows = false;  ///< a long clip's frames are solved in windows (kChainFramesAtOnce)
  bool of_sample = false;   ///< of some of a long clip's frames, whose cost is not that of the clip
};
/// A solve of some frames at once takes memory for each: chain some 100 KB and Ceres 310 KB (docs/lab/run_speed.md,
/// "Memory"). Clips of more than `whole` frames are therefore solved in overlapping windows once a sample of
/// the coarse frames has told shape and focal length.
struct FramesAtOnce {
  int whole, window;
};
inline constexpr FramesAtOnce kChainFramesAtOnce{2000, 1000}, kCeresFramesAtOnce{1000, 500};
/// Number of a long clip's coarse frames that tell shape and focal length (SequenceSample).
inline constexpr int kSampleFrames = 1000;

/// Coarse in time first: neighbouring frames resolve the ambiguities of a single frame, and 15 frames a second are
/// enough for human motion. All stages but the last solve the coarse frames.
struct Stages {
  Stage near_start;  ///< pulled towards the start, wide kernels; not from an initialiser
  Stage coarse;      ///< observations and priors
  Stage again;       ///< with the clip's own smoothness and its ground
  Stage round;       ///< each round of a term (problem/clip_term.h); its name and iterations are the term's
  Stage all;         ///< every frame: few steps after a coarse solve, in which the slow directions have converged
  Stage finish;      ///< every frame by Ceres, to its own convergence (SequenceSolver::kChainThenCeres)
};
/// `coarse_to_fine`: the coarse frames are fewer than all.
Stages StagesFor(const TrackSequenceInput& input, const TrackSequenceOptions& options, bool coarse_to_fine);

/// Solves stages and keeps the summary and the clock; once one has failed or was stopped, later ones do nothing.
class StageRunner {
 public:
  /// All are borrowed.
  StageRunner(const TrackSequenceInput& input, const TrackSequenceOptions& options, int num_threads, StageClock* clock,
              TrackSequenceSummary* summary)
      : input_(input), options_(options), num_threads_(num_threads), clock_(clock), summary_(summary) {}

  /// True while the run may go on.
  [[nodiscard]] bool ok() const { return ok_; }
  /// `held`: SolveOptions::held.
  bool Run(const Stage& stage, SequenceProblem* problem, std::vector<char> held = {}) {
    const bool ceres = options_.solver == SequenceSolver::kCeres;
    return Run(stage, ceres ? SequenceSolver::kCeres : SequenceSolver::kChain, problem, std::move(held));
  }
  bool Run(const Stage& stage, SequenceSolver solver, SequenceProblem* problem, std::vector<char> held = {});
  /// True if the stages of this problem whose shape and focal length are known are solved by chain in windows.
  [[nodiscard]] bool InWindows(const SequenceProblem& problem) const;

 private:
  const TrackSequenceInput& input_;
  const TrackSequenceOptions& options_;
  int num_threads_;
  StageClock* clock_;
  TrackSequenceSummary* summary_;
  bool ok_ = true;
};

}  // namespace bodyloom
