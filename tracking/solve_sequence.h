// SPDX-License-Identifier: Apache-2.0
/// Solves a SequenceProblem with the engine that the options name.
#pragma once

#include "bodyloom/tracking/sequence_problem.h"
#include "bodyloom/tracking/solve_options.h"

namespace bodyloom {

/// The problem's states, betas and log_focal hold the answer afterwards. The answer is the same to the last bit for any
/// number of threads. Throws std::invalid_argument when the problem's sizes contradict each other.
SolveReport SolveSequence(SequenceProblem* problem, const SolveOptions& options);

}  // namespace bodyloom
