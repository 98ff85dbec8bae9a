// SPDX-License-Identifier: Apache-2.0
/// A SequenceProblem by Ceres: Levenberg–Marquardt with sparse Cholesky on the blocks of ceres_problem.h, for any
/// structure.
#pragma once

#include "bodyloom/tracking/sequence_problem.h"
#include "bodyloom/tracking/solve_options.h"

namespace bodyloom {

/// As SolveSequence(), which calls it.
SolveReport SolveWithCeres(SequenceProblem* problem, const SolveOptions& options);

}  // namespace bodyloom
