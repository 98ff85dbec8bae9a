// SPDX-License-Identifier: Apache-2.0
// What users' cost functions on neighbouring frames (terms/own/neighbours_cost.h) cost, and what they give to
// ChainProblem's matrix: blocks of two frames, the coupling between them, and their arrow.
#include <cmath>
#include <limits>
#include <utility>

#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/tracking/chain/chain_problem.h"
#include "bodyloom/tracking/terms/own/neighbours_cost.h"

namespace bodyloom {

double ChainProblem::EvaluatePairs(const ChainPoint& point, bool derivatives) {
  const int T = static_cast<int>(point.states.size());
  ParallelFor(T, num_threads_, [&](int t) {
    if (pairs_[t].coupled && !AllFrozen(t, t + 1)) EvaluatePair(t, point, derivatives);
  });
  double sum = 0;
  for (const Pair& pair : pairs_) sum += pair.cost;
  return sum;
}

void ChainProblem::EvaluatePair(int t, const ChainPoint& point, bool derivatives) {
  const std::vector<OwnCost>& costs = problem_.frames[t].own.with_next;
  Pair& pair = pairs_[t];
  pair.cost = 0;
  if (derivatives) {
    int rows = 0;
    for (const OwnCost& cost : costs) rows += cost.function->num_residuals();
    pair.J.resize(rows, 2 * n_ + problem_.layout.num_betas);
    pair.r.resize(rows);
  }
  NeighboursResidual residual;
  int row = 0;
  for (const OwnCost& cost : costs) {
    EvaluateNeighbours(cost, problem_.layout, point.states[t], point.states[t + 1], point.betas, derivatives,
                       &residual);
    if (!residual.valid) {
      pair.cost = std::numeric_limits<double>::quiet_NaN();
      return;
    }
    const OwnLoss loss = EvaluateOwnLoss(cost, residual.r.squaredNorm());
    pair.cost += 0.5 * loss.rho;
    if (!derivatives) continue;
    const double scale = std::sqrt(loss.weight);
    const Eigen::Index count = residual.r.size();
    pair.J.middleRows(row, count) = scale * residual.J;
    pair.r.segment(row, count) = scale * residual.r;
    row += static_cast<int>(count);
  }
  if (derivatives) pair.next.noalias() = pair.J.leftCols(n_).transpose() * pair.J.middleCols(n_, n_);
}

void ChainProblem::AssemblePairs(int t) {
  const auto offset = static_cast<Eigen::Index>(t) * n_;
  const auto add = [&](const Pair& pair, int column) {
    if (!pair.coupled) return;
    const auto J = pair.J.middleCols(column, n_);
    gradient_.segment(offset, n_) += J.transpose() * pair.r;
    diagonal_.segment(offset, n_) += J.colwise().squaredNorm().transpose();
  };
  add(pairs_[t], 0);
  if (t > 0) add(pairs_[t - 1], n_);
}

void ChainProblem::AddPairs(int t, double* a, int64_t a_stride, double* b, int64_t b_stride) const {
  const auto add = [&](const Pair& pair, int column) {
    if (!pair.coupled) return;
    const auto J = pair.J.middleCols(column, n_);
    for (int i = 0; i < n_; ++i) {
      for (int j = i; j < n_; ++j) a[i * a_stride + j] += J.col(i).dot(J.col(j));
      for (int j = 0; j < problem_.layout.num_betas && !shape_constant_; ++j) {
        b[i * b_stride + j] += J.col(i).dot(pair.J.col(2 * n_ + j));
      }
    }
  };
  add(pairs_[t], 0);
  if (t > 0) add(pairs_[t - 1], n_);
}

}  // namespace bodyloom
