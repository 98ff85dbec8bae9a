// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/solve_options.h"

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

std::string ToString(SequenceSolver solver) {
  switch (solver) {
    case SequenceSolver::kCeres:
      return "ceres";
    case SequenceSolver::kChain:
      return "chain";
    case SequenceSolver::kChainThenCeres:
      return "chain+ceres";
  }
  return "";
}

SequenceSolver SequenceSolverFromString(const std::string& word) {
  for (const auto solver : {SequenceSolver::kCeres, SequenceSolver::kChain, SequenceSolver::kChainThenCeres}) {
    if (word == ToString(solver)) return solver;
  }
  BODYLOOM_CHECK(false, "solver '", word, "' is unknown; expected 'chain+ceres', 'ceres' or 'chain'");
  return SequenceSolver::kChainThenCeres;
}

std::string ToString(SolveStatus status) {
  switch (status) {
    case SolveStatus::kFailure:
      return "failure";
    case SolveStatus::kConverged:
      return "converged";
    case SolveStatus::kMaxIterations:
      return "max_iterations";
    case SolveStatus::kStopped:
      return "stopped";
  }
  return "failure";
}

}  // namespace bodyloom
