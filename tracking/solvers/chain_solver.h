// SPDX-License-Identifier: Apache-2.0
/// Levenberg–Marquardt on a SequenceProblem that knows its shape: a chain of frames with an arrow of shared unknowns.
///
/// Each step solves (H + Λ) δ = −g exactly (tracking/solvers/chain/chain_factor.h), Λ = clamp(S² diag H, 1e-6, 1e32) /
/// (r S²) with Ceres' column scaling S = 1/(1 + √diag H) of the first point, and is judged as Ceres 2.1 judges it:
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

#include <Eigen/Core>
#include <vector>

#include "tracking/problem/sequence_problem.h"
#include "tracking/problem/track_options.h"
#include "tracking/solvers/chain/chain_factor.h"
#include "tracking/solvers/chain/chain_problem.h"

namespace bodyloom {

/// As SolveSequence(), which calls it.
SolveReport SolveChain(SequenceProblem* problem, const SolveOptions& options);

/// The iterations alone, from `x` on, which holds the best point afterwards (also after a failure). The linearisations
/// that `chain` holds already are used where options.chain.reuse_linearisation lets them. `early`: begin with
/// options.chain.early_dense.
SolveReport DescendChain(ChainProblem* chain, ChainFactor* factor, ChainPoint* x, const SolveOptions& options,
                         bool early);

// Frozen frames of a chain: which frames stay where they are for a while. After a few steps most frames have converged
// and a few move on along valleys of their own; steps of those few cost a few frames' work instead of the whole
// clip's.
//
// A frame's predicted decrease is its share in the quadratic model's decrease of the last step that it took part in,
// ½ |g_tᵀδ_t| + ½ δ_tᵀΛ_tδ_t.
// The frames with the least predicted decrease are frozen, together at most `share` of the step's decrease at a time.
// All are released when the predicted decrease of the others falls below twice what the frozen ones had left; or,
// where the frozen ones had less than a tenth of the descent's tolerance left, when the others have converged. Which
// frames are frozen is decided by predicted decreases alone, so the path does not depend on the number of threads.

class FrozenFrames {
 public:
  /// 0: none is ever frozen.
  explicit FrozenFrames(double share) : share_(share) {}

  [[nodiscard]] bool any() const { return !frames_.empty(); }
  /// T, or empty: none.
  [[nodiscard]] const std::vector<char>& frames() const { return frames_; }
  /// Part of the frames that moves.
  [[nodiscard]] double moving_share() const { return moving_share_; }

  /// A step of frames of n values each (T·n; zero where they are frozen) that is about to be tried.
  void Tried(const Eigen::VectorXd& gradient, const Eigen::VectorXd& damping, const Eigen::VectorXd& step, int n);
  /// That step was taken, with this predicted decrease. More frames may be frozen now, or all are released: `tolerance`
  /// is the change of the cost at which the descent ends.
  void Taken(double predicted_decrease, double tolerance);
  /// Releases all.
  void Clear();

 private:
  void Plan(double more);
  [[nodiscard]] bool IsFrozen(Eigen::Index t) const { return any() && frames_[t] != 0; }

  double share_, frozen_decrease_ = 0, moving_share_ = 1;
  std::vector<char> frames_;
  Eigen::VectorXd predicted_decreases_;
};

}  // namespace bodyloom
