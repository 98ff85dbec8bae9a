// SPDX-License-Identifier: Apache-2.0
/// Levenberg–Marquardt on a SequenceProblem that exploits its structure: a chain of frames with an arrow of shared
/// unknowns.
///
/// Each step solves (H + Λ) δ = −g exactly (tracking/solvers/chain/chain_factor.h), Λ = clamp(S² diag H, 1e-6, 1e32) /
/// (r S²) with Ceres' column scaling S = 1/(1 + √diag H) of the first point. Steps are accepted and the descent ends by
/// the rules of Ceres 2.1:
///   accepted when Δcost > 1e-3 of the predicted decrease (the quadratic model's); then
///   r ← r / max(1/3, 1 − (2 q − 1)³), q the ratio of the two;
///   rejected: r ← r/2, then r/4, r/8, …
///   ends when |Δcost| ≤ function_tolerance · cost, ‖step‖ ≤ parameter_tolerance (‖x‖ + parameter_tolerance), the
///   gradient's largest component ≤ gradient_tolerance, max_iterations, or r < 1e-32; fails after five steps in a row
///   that could not be computed.
/// Two differences: the last step, too small to continue, is kept if it lowers the cost (Ceres discards it); and a step
/// that was predicted to lower the cost by more than three times the tolerance does not end the descent. It is too long
/// (a limit of a joint lies between), and is rejected.
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

/// Implements SolveSequence() for the chain engine. `held`: T flags of frames that keep their states; between frames
/// that move at least two in a row are held, as accelerations couple three. With any, the shared values keep theirs,
/// too. Empty: none.
SolveReport SolveChain(SequenceProblem* problem, const SolveOptions& options, const std::vector<char>& held = {});

/// Runs the iterations from `x`, which holds the best point afterwards (also after a failure). Linearisations already
/// in `chain` are used as options.chain.reuse_linearisation permits. `early`: begin with options.chain.early_dense.
/// `held`: as of SolveChain().
SolveReport DescendChain(ChainProblem* chain, ChainFactor* factor, ChainPoint* x, const SolveOptions& options,
                         bool early, const std::vector<char>& held = {});

/// Selects frames of a chain that are temporarily held constant. After a few steps most frames have converged and a few
/// still move along narrow valleys; steps of only these cost a few frames' work instead of the whole clip's.
///
/// A frame's predicted decrease is its share in the quadratic model's decrease of its last step,
///   ½ |g_tᵀδ_t| + ½ δ_tᵀΛ_tδ_t.
/// The frames with the smallest predicted decreases are frozen, together at most `share` of the step's decrease at a
/// time. All are released when the predicted decrease of the others falls below twice that of the frozen ones; or, if
/// that of the frozen ones is less than a tenth of the descent's tolerance, when the others have converged. The
/// selection depends only on predicted decreases, so the path does not depend on the number of threads.
class FrozenFrames {
 public:
  /// `share` 0: no frame is ever frozen.
  explicit FrozenFrames(double share) : share_(share) {}

  [[nodiscard]] bool any() const { return !frames_.empty(); }
  /// T flags, or empty: none.
  [[nodiscard]] const std::vector<char>& frames() const { return frames_; }
  /// Share of the frames that are not frozen.
  [[nodiscard]] double moving_share() const { return moving_share_; }

  /// Records a step before its evaluation: n values a frame (T·n; zero for frozen frames).
  void Tried(const Eigen::VectorXd& gradient, const Eigen::VectorXd& damping, const Eigen::VectorXd& step, int n);
  /// Records that the step was accepted, with this predicted decrease; then freezes more frames or releases all.
  /// `tolerance`: change of the cost at which the descent ends.
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
