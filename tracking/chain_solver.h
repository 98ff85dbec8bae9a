// SPDX-License-Identifier: Apache-2.0
/// Levenberg–Marquardt on a SequenceProblem that knows its shape: a chain of frames with an arrow of shared unknowns.
///
/// Each step solves (H + Λ) δ = −g exactly (tracking/chain/chain_factor.h), Λ = clamp(S² diag H, 1e-6, 1e32) / (r S²)
/// with Ceres' column scaling S = 1/(1 + √diag H) of the first point, and is judged as Ceres 2.1 judges it:
///   accepted when Δcost > 1e-3 of the predicted decrease (the quadratic model's); then
///   r ← r / max(1/3, 1 − (2 q − 1)³), q the ratio of the two;
///   rejected: r ← r/2, then r/4, r/8, …
///   ends when |Δcost| ≤ function_tolerance · cost, ‖step‖ ≤ parameter_tolerance (‖x‖ + parameter_tolerance), the
///   gradient's largest component ≤ gradient_tolerance, max_iterations, or r < 1e-32; fails after five steps in a row
///   that could not be computed.
/// One difference: the last step, found too small to go on, is kept when it lowers the cost (Ceres drops it).
/// Source of the rules: Ceres Solver 2.1 (trust_region_minimizer, levenberg_marquardt_strategy); Madsen, Nielsen,
/// Tingleff, "Methods for non-linear least squares problems", 2004.
#pragma once

#include "bodyloom/tracking/chain/chain_factor.h"
#include "bodyloom/tracking/chain/chain_problem.h"
#include "bodyloom/tracking/sequence_problem.h"
#include "bodyloom/tracking/solve_options.h"

namespace bodyloom {

/// As SolveSequence(), which calls it.
SolveReport SolveChain(SequenceProblem* problem, const SolveOptions& options);

/// The iterations alone, from `x` on, which holds the best point afterwards (also after a failure). The linearisations
/// that `chain` holds already are used where options.chain.reuse_linearisation lets them. `early`: begin with
/// options.chain.early_dense.
SolveReport DescendChain(ChainProblem* chain, ChainFactor* factor, ChainPoint* x, const SolveOptions& options,
                         bool early);

}  // namespace bodyloom
