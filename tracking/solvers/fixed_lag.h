// SPDX-License-Identifier: Apache-2.0
/// Fixed-lag smoother: solves the last frames of a growing chain.
///
/// A window of at most `max_frames` frames is solved by the iterations of chain_solver.h. When it is full, its oldest
/// frame is marginalised to a ChainPrior on the next two frames and on shape and focal length. Time and memory per
/// frame are bounded. In a linear Gaussian problem the window's states equal those of a solve of all frames so far.
#pragma once

#include <functional>

#include "tracking/problem/sequence_problem.h"
#include "tracking/problem/track_options.h"
#include "tracking/solvers/chain/chain_factor.h"
#include "tracking/solvers/chain/chain_problem.h"

namespace bodyloom {

class FixedLag {
 public:
  /// `clip` holds everything but frames (layout, smoothness, shape prior, betas, focal length). max_frames ≥ 3.
  FixedLag(SequenceProblem clip, int max_frames, int num_threads);
  FixedLag(const FixedLag&) = delete;
  FixedLag& operator=(const FixedLag&) = delete;

  /// Appends a frame at its starting state; when the window is full, removes its first frame. `cut_before`: it does not
  /// continue the last one. Returns the number of frames removed (0 or 1).
  int Add(FrameData frame, FrameState start, double timestamp, bool cut_before);

  /// Runs at most this many iterations, with ChainOptions::reuse_linearisation = `reuse_share`. After a failure the
  /// states are at the best point found.
  SolveReport Solve(int max_iterations, double reuse_share, double function_tolerance = 1e-5);

  /// Runs VisitCovariance() of chain_inverse.h at the window's states, for its frames begin ≤ t < end; removed frames
  /// count through the prior. Does not affect later solves.
  bool VisitCovariance(int begin, int end, const std::function<void(int, const Eigen::MatrixXd&)>& visit);

  /// Shape prior, betas, states and observations may be changed between calls; Touch(t) after the latter.
  [[nodiscard]] SequenceProblem& problem() { return problem_; }
  [[nodiscard]] const SequenceProblem& problem() const { return problem_; }
  void Touch(int t) { chain_.Forget(t); }
  /// Makes frame t of the window one that does not continue the one before; it keeps no information of earlier frames.
  void Cut(int t);
  void LimitPoints(int max_points) { chain_.LimitPoints(max_points); }
  [[nodiscard]] int num_frames() const { return static_cast<int>(problem_.states.size()); }
  [[nodiscard]] const ChainPrior& prior() const { return prior_; }

 private:
  void DropFirst();

  SequenceProblem problem_;
  int max_frames_, num_threads_;
  ChainProblem chain_;
  ChainFactor factor_;
  ChainPrior prior_;
};

}  // namespace bodyloom
