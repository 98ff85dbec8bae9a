// SPDX-License-Identifier: Apache-2.0
#include "tracking/clip/track_stages.h"

#include <cmath>

#include "tracking/solvers/chain/chain_problem.h"
#include "tracking/solvers/solve_sequence.h"

namespace bodyloom {

Stages StagesFor(const TrackSequenceInput& input, const TrackSequenceOptions& options, bool coarse_to_fine) {
  // Without an initialiser the start is a guess, to which the final track is not pulled.
  const double pull = input.initialiser == nullptr ? 0.0 : options.initialiser_weight;
  const int max = options.max_iterations, fine = coarse_to_fine ? options.max_fine_iterations : max;
  Stages stages{
      // name, pull, kernel, tolerance, iterations, from, to, in windows
      .near_start = {"fit near start", options.start_pull, 8, 1e-3, max, 0.05, 0.3},
      .coarse = {"fit coarse", pull, 4, 1e-4, max, 0.3, 0.45},
      .again = {"fit again", pull, 4, 1e-4, max, 0.45, 0.5},
      .round = {"", pull, 4, 1e-4, 0, 0.5, 0.6},
      .all = {"fit", pull, 4, 1e-4, fine, 0.6, 0.8, true},
      .finish = {"ceres", pull, 4, 1e-4, max, 0.8, 0.95, true},
  };
  if (options.function_tolerance > 0) {
    for (Stage* stage :
         {&stages.near_start, &stages.coarse, &stages.again, &stages.round, &stages.all, &stages.finish}) {
      stage->tolerance = options.function_tolerance;
    }
  }
  return stages;
}

bool StageRunner::InWindows(const SequenceProblem& problem) const {
  return options_.solver != SequenceSolver::kCeres && problem.couplings.empty() &&
         NumFarRows(problem) <= ChainProblem::kMaxFarRows &&
         problem.states.size() > static_cast<size_t>(kChainFramesAtOnce.whole);
}

bool StageRunner::Run(const Stage& stage, SequenceSolver solver, SequenceProblem* problem, std::vector<char> held) {
  if (!ok_) return false;
  for (const FrameData& frame : problem->frames) {
    frame.ForEachTerm([&](FrameTerm* term, int /*view*/) { term->BeginStage({stage.pull, stage.landmark_kernel}); });
  }
  if (solver == SequenceSolver::kChain && NumFarRows(*problem) > ChainProblem::kMaxFarRows) {
    solver = SequenceSolver::kCeres;
  }
  SolveOptions solve;
  solve.solver = solver;
  if (options_.skip_unneeded) {
    solve.chain.early_dense = kTrackerEarlyDense;
    solve.chain.frozen_share = kTrackerFrozenShare;
    // Joints alone are evaluated as fast as skipped: 10 % slower with it on AIST++.
    if (input_.dense != nullptr) solve.chain.reuse_linearisation = kTrackerReuse;
  }
  const FramesAtOnce& at_once = solver == SequenceSolver::kCeres ? kCeresFramesAtOnce : kChainFramesAtOnce;
  if (options_.solver != SequenceSolver::kCeres && stage.in_windows &&
      problem->states.size() > static_cast<size_t>(at_once.whole)) {
    solve.max_frames_at_once = at_once.window;
  }
  solve.held = std::move(held);
  solve.max_iterations = stage.max_iterations;
  solve.num_threads = num_threads_;
  solve.function_tolerance = stage.tolerance;
  // Ceres discards the last step when it is too small to continue, whereas chain keeps it. Where all stages run in
  // Ceres, the tolerance is therefore a tenth of chain's.
  if (options_.solver == SequenceSolver::kCeres && options_.function_tolerance == 0) solve.function_tolerance /= 10;
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
  if (summary_->initial_cost == 0 && !stage.of_sample) summary_->initial_cost = report.initial_cost;
  summary_->final_cost = report.final_cost;
  summary_->status = report.status;
  summary_->message = report.message;
  clock_->Record(stage.name);
  if (solver == SequenceSolver::kCeres) {
    CeresSummary& ceres = summary_->ceres;
    ceres = {true, report.iterations, report.initial_cost, report.final_cost, report.gradient_max_norm, report.seconds};
  }
  ok_ = report.status != SolveStatus::kFailure && report.status != SolveStatus::kStopped;
  return ok_;
}

}  // namespace bodyloom
