// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/track_stages.h"

#include <cmath>

#include "bodyloom/tracking/solve_sequence.h"

namespace bodyloom {

Stages StagesFor(const TrackSequenceInput& input, const TrackSequenceOptions& options, bool coarse_to_fine) {
  // Without an initialiser the start is a guess: nothing keeps the track near it in the end.
  const double pull = input.initialiser == nullptr ? 0.0 : options.initialiser_weight;
  const int most = options.max_iterations, fine = coarse_to_fine ? options.max_fine_iterations : most;
  Stages stages{
      // name, pull, kernel, tolerance, iterations, from, to
      .near_start = {"fit near start", options.start_pull, 8, 1e-3, most, 0.05, 0.3},
      .coarse = {"fit coarse", pull, 4, 1e-4, most, 0.3, 0.45},
      .again = {"fit again", pull, 4, 1e-4, most, 0.45, 0.5},
      .part_labels = {"fit part labels", pull, 4, 1e-4, options.part_labels.max_iterations, 0.5, 0.55},
      .dense = {"fit dense", pull, 4, 1e-4, options.rendered_uv.max_iterations, 0.55, 0.6},
      .all = {"fit", pull, 4, 1e-4, fine, 0.6, 0.95},
  };
  if (options.function_tolerance > 0) {
    for (Stage* stage :
         {&stages.near_start, &stages.coarse, &stages.again, &stages.part_labels, &stages.dense, &stages.all}) {
      stage->tolerance = options.function_tolerance;
    }
  }
  return stages;
}

bool StageRunner::Run(const Stage& stage, SequenceProblem* problem) {
  if (!going_) return false;
  for (FrameData& frame : problem->frames) {
    frame.initialiser.weight = stage.pull;
    frame.landmarks.kernel = stage.landmark_kernel;
  }
  SolveOptions solve;
  solve.solver = options_.solver;
  if (options_.skip_unneeded) {
    solve.chain.early_dense = kTrackerEarlyDense;
    solve.chain.frozen_share = kTrackerFrozenShare;
    // Joints alone are evaluated as fast as skipped: 10 % slower with it on AIST++.
    if (input_.dense != nullptr) solve.chain.reuse_linearisation = kTrackerReuse;
  }
  solve.max_iterations = stage.max_iterations;
  solve.num_threads = num_threads_;
  solve.function_tolerance = stage.tolerance;
  if (options_.progress) {
    solve.on_iteration = [&](int iteration, double cost) {
      const double done = 1 - std::exp(-iteration / 6.0);
      return options_.progress({stage.name, stage.from + (stage.to - stage.from) * done, cost});
    };
  }
  const SolveReport report = SolveSequence(problem, solve);
  summary_->iterations += report.iterations;
  summary_->seconds_evaluation += report.seconds_evaluation;
  summary_->seconds_linear_solver += report.seconds_linear_solver;
  if (summary_->initial_cost == 0) summary_->initial_cost = report.initial_cost;
  summary_->final_cost = report.final_cost;
  summary_->status = report.status;
  summary_->message = report.message;
  clock_->Book(stage.name);
  going_ = report.status != SolveStatus::kFailure && report.status != SolveStatus::kStopped;
  return going_;
}

}  // namespace bodyloom
