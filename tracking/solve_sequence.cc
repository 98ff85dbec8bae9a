// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/solve_sequence.h"

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/tracking/ceres_solver.h"
#include "bodyloom/tracking/chain_solver.h"

namespace bodyloom {

SolveReport SolveSequence(SequenceProblem* problem, const SolveOptions& options) {
  const size_t T = problem->states.size();
  BODYLOOM_CHECK(
      T > 0 && problem->frames.size() == T && problem->timestamps.size() == T && problem->cut_before.size() == T,
      "sequence: ", T, " states, ", problem->frames.size(), " frames, ", problem->timestamps.size(), " timestamps, ",
      problem->cut_before.size(), " cut flags; expected the same number of each");
  BODYLOOM_CHECK(problem->betas.size() == problem->layout.num_betas, "sequence: ", problem->betas.size(),
                 " betas, the layout has ", problem->layout.num_betas);
  if (options.solver == SequenceSolver::kCeres) return SolveWithCeres(problem, options);
  SolveReport chain = SolveChain(problem, options);
  const bool ended = chain.status == SolveStatus::kFailure || chain.status == SolveStatus::kStopped;
  if (options.solver == SequenceSolver::kChain || ended) return chain;
  SolveReport report = SolveWithCeres(problem, options);
  report.iterations += chain.iterations;
  report.initial_cost = chain.initial_cost;
  report.seconds += chain.seconds;
  report.seconds_evaluation += chain.seconds_evaluation;
  report.seconds_linear_solver += chain.seconds_linear_solver;
  report.frames_evaluated = chain.frames_evaluated;
  report.frames_skipped = chain.frames_skipped;
  return report;
}

}  // namespace bodyloom
