// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/fixed_lag.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"
#include "tracking/solvers/chain/chain_inverse.h"
#include "tracking/solvers/chain_solver.h"

namespace bodyloom {

FixedLag::FixedLag(SequenceProblem clip, int max_frames, int num_threads)
    : problem_(std::move(clip)),
      max_frames_(max_frames),
      num_threads_(num_threads),
      chain_(problem_, false, false, num_threads),
      factor_(chain_.frame_size(), chain_.shared_size(), {0}) {
  BODYLOOM_CHECK(max_frames >= 3 && problem_.states.empty(), "fixed lag: a window of ", max_frames, " frames and ",
                 problem_.states.size(), " to begin with; expected at least three, and none");
}

void FixedLag::DropFirst() {
  const ChainPoint x(problem_.states, problem_);
  ChainPrior next;
  // If the first frame cannot be eliminated its information is dropped; the next frames are determined without it.
  if (!std::isfinite(chain_.Linearise(x)) || !chain_.Marginalise(x, &next)) next = ChainPrior();
  prior_ = std::move(next);
  chain_.SetPrior(prior_.set ? &prior_ : nullptr);
  problem_.states.erase(problem_.states.begin());
  problem_.frames.erase(problem_.frames.begin());
  problem_.timestamps.erase(problem_.timestamps.begin());
  problem_.cut_before.erase(problem_.cut_before.begin());
}

int FixedLag::Add(FrameData frame, FrameState start, double timestamp, bool cut_before) {
  const int dropped = num_frames() == max_frames_ ? 1 : 0;
  if (dropped > 0) DropFirst();
  problem_.frames.push_back(std::move(frame));
  problem_.states.push_back(std::move(start));
  problem_.timestamps.push_back(timestamp);
  problem_.cut_before.push_back(cut_before ? 1 : 0);
  chain_.Moved(dropped);
  factor_.SetCuts(problem_.cut_before);
  return dropped;
}

void FixedLag::Cut(int t) {
  BODYLOOM_CHECK(t >= 0 && t < num_frames(), "fixed lag: a cut at frame ", t, " of ", num_frames());
  problem_.cut_before[t] = 1;
  if (t <= 1 && prior_.set) {
    // Its marginal on shape and focal length once nothing is known of the first two poses.
    const int p = 2 * chain_.frame_size(), s = chain_.shared_size();
    const Eigen::MatrixXd coupling = prior_.M.topRightCorner(p, s);
    const Eigen::LDLT<Eigen::MatrixXd> poses(prior_.M.topLeftCorner(p, p) + 1e-6 * Eigen::MatrixXd::Identity(p, p));
    prior_.M.bottomRightCorner(s, s) -= coupling.transpose() * poses.solve(coupling);
    prior_.m.tail(s) -= coupling.transpose() * poses.solve(prior_.m.head(p));
    prior_.M.topRows(p).setZero();
    prior_.M.leftCols(p).setZero();
    prior_.m.head(p).setZero();
    if (!prior_.M.allFinite() || !prior_.m.allFinite()) {
      prior_ = ChainPrior();
      chain_.SetPrior(nullptr);
    }
  }
  chain_.Moved(0);
  factor_.SetCuts(problem_.cut_before);
}

bool FixedLag::VisitCovariance(int begin, int end, const std::function<void(int, const Eigen::MatrixXd&)>& visit) {
  // The next solve begins by linearising here, too.
  return std::isfinite(chain_.Linearise(ChainPoint(problem_.states, problem_))) &&
         bodyloom::VisitCovariance(&chain_, &factor_, begin, end, num_threads_, visit);
}

SolveReport FixedLag::Solve(int max_iterations, double reuse_share, double function_tolerance) {
  SolveOptions options;
  options.function_tolerance = function_tolerance;
  options.max_iterations = max_iterations;
  options.num_threads = num_threads_;
  options.chain.reuse_linearisation = reuse_share;
  options.chain.reuse_to_the_end = true;
  ChainPoint x(std::move(problem_.states), problem_);
  SolveReport report = DescendChain(&chain_, &factor_, &x, options, false);
  problem_.states = std::move(x.states);
  problem_.betas = x.betas;
  problem_.log_focal = x.log_focal;
  return report;
}

}  // namespace bodyloom
