// SPDX-License-Identifier: Apache-2.0
/// A SequenceProblem by Ceres: Levenberg–Marquardt with sparse Cholesky, for any structure. The reference that the
/// chain engine is checked against.
#pragma once

#include "bodyloom/tracking/sequence_problem.h"
#include "bodyloom/tracking/solve_options.h"

namespace bodyloom {

/// As SolveSequence(), which calls it.
SolveReport SolveWithCeres(SequenceProblem* problem, const SolveOptions& options);

}  // namespace bodyloom
