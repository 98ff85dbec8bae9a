// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/solve_options.h"

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

std::string ToString(SequenceSolver solver) { return solver == SequenceSolver::kChain ? "chain" : "ceres"; }

SequenceSolver SequenceSolverFromString(const std::string& word) {
  BODYLOOM_CHECK(word == "ceres" || word == "chain", "solver '", word, "' is unknown; expected 'ceres' or 'chain'");
  return word == "chain" ? SequenceSolver::kChain : SequenceSolver::kCeres;
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
