// SPDX-License-Identifier: Apache-2.0
// Costs of users' cost functions on several frames (problem/user_cost.h), and their part of ChainProblem's matrix. Two
// consecutive frames: the blocks of both, the coupling between them, and their arrow. Frames farther apart would fill
// the band; with J the rows of all of them, H + JᵀJ is solved instead as the larger arrow
//   ⎡ H   Jᵀ ⎤ ⎡ δ ⎤   ⎡ −g ⎤
//   ⎣ J  −1  ⎦ ⎣ λ ⎦ = ⎣  0 ⎦
// whose multipliers λ are shared columns like the shape's.
#include <ceres/cost_function.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "tracking/solvers/chain/chain_problem.h"

namespace bodyloom {
namespace {

bool AreNeighbours(const SequenceProblem& problem, const std::vector<int>& frames) {
  return frames.size() == 2 && frames[0] + 1 == frames[1] && problem.cut_before[frames[1]] == 0;
}

}  // namespace

int NumFarRows(const SequenceProblem& problem) {
  int rows = 0;
  for (const FrameCoupling& coupling : problem.couplings) {
    if (!AreNeighbours(problem, coupling.frames)) rows += coupling.cost.function->num_residuals();
  }
  return rows;
}

void ChainProblem::ResizeCouplings() {
  couplings_.clear();
  num_far_rows_ = 0;
  const size_t T = problem_.states.size();
  pairs_of_frame_.assign(problem_.couplings.empty() ? 0 : T, {});
  far_of_frame_.assign(pairs_of_frame_.size(), {});
  pair_next_.resize(pairs_of_frame_.size());
  for (const FrameCoupling& given : problem_.couplings) {
    Coupling& coupling = couplings_.emplace_back();
    coupling.source = &given;
    const int index = static_cast<int>(couplings_.size()) - 1;
    if (AreNeighbours(problem_, given.frames)) {
      pairs_of_frame_[given.frames[0]].push_back({index, 0});
      pairs_of_frame_[given.frames[1]].push_back({index, 1});
      continue;
    }
    coupling.first_far_row = num_far_rows_;
    num_far_rows_ += given.cost.function->num_residuals();
    for (size_t k = 0; k < given.frames.size(); ++k) {
      far_of_frame_[given.frames[k]].push_back({index, static_cast<int>(k)});
    }
  }
  BODYLOOM_CHECK(num_far_rows_ <= kMaxFarRows, "chain: terms that couple frames apart from each other have ",
                 num_far_rows_, " residuals, expected at most ", kMaxFarRows, "; more are Ceres' to solve");
}

double ChainProblem::EvaluateCouplings(const ChainPoint& point, bool derivatives) {
  ParallelFor(static_cast<int>(couplings_.size()), num_threads_, [&](int i) {
    Coupling& coupling = couplings_[i];
    const std::vector<int>& frames = coupling.source->frames;
    if (AllFrozen(frames.front(), frames.back())) return;
    EvaluateCoupling(point, derivatives, &coupling);
  });
  double sum = 0;
  for (const Coupling& coupling : couplings_) sum += coupling.cost;
  if (!derivatives) return sum;
  for (size_t t = 0; t < pairs_of_frame_.size(); ++t) {
    bool first = true;
    for (const auto& [index, k] : pairs_of_frame_[t]) {
      if (k != 0) continue;
      const RowMatrixXd& J = couplings_[index].at.J;
      if (first) pair_next_[t].setZero(n_, n_);
      first = false;
      pair_next_[t].noalias() += J.leftCols(n_).transpose() * J.middleCols(n_, n_);
    }
    if (first) pair_next_[t].resize(0, 0);
  }
  return sum;
}

void ChainProblem::EvaluateCoupling(const ChainPoint& point, bool derivatives, Coupling* coupling) const {
  const FrameCoupling& source = *coupling->source;
  std::vector<const FrameState*> states;
  for (const int t : source.frames) states.push_back(&point.states[t]);
  UserResidual& at = coupling->at;
  EvaluateUserCost(source.cost, problem_.layout, states, point.betas, point.log_focal, derivatives, &at);
  if (!at.valid) {
    coupling->cost = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  const LossValue loss = EvaluateLoss(source.cost, at.r.squaredNorm());
  coupling->cost = 0.5 * loss.rho;
  if (!derivatives) return;
  const double scale = std::sqrt(loss.weight);
  at.J *= scale;
  at.r *= scale;
}

int ChainProblem::SharedColumnOf(const Coupling& coupling, int shared) const {
  const int frames = static_cast<int>(coupling.source->frames.size());
  return frames * n_ + shared_columns_[shared] - problem_.layout.beta_column;
}

void ChainProblem::AssembleCouplings(int t) {
  const auto offset = static_cast<Eigen::Index>(t) * n_;
  for (const auto* of_frame : {&pairs_of_frame_[t], &far_of_frame_[t]}) {
    for (const auto& [index, k] : *of_frame) {
      const Coupling& coupling = couplings_[index];
      const auto J = coupling.at.J.middleCols(k * n_, n_);
      gradient_.segment(offset, n_) += J.transpose() * coupling.at.r;
      diagonal_.segment(offset, n_) += J.colwise().squaredNorm().transpose();
    }
  }
}

void ChainProblem::AddCouplings(int t, double* a, int64_t a_stride, double* b, int64_t b_stride) const {
  for (const auto& [index, k] : pairs_of_frame_[t]) {
    const Coupling& coupling = couplings_[index];
    const auto J = coupling.at.J.middleCols(k * n_, n_);
    for (int i = 0; i < n_; ++i) {
      for (int j = i; j < n_; ++j) a[i * a_stride + j] += J.col(i).dot(J.col(j));
      for (int j = 0; j < shared_size(); ++j) {
        b[i * b_stride + j] += J.col(i).dot(coupling.at.J.col(SharedColumnOf(coupling, j)));
      }
    }
  }
  for (const auto& [index, k] : far_of_frame_[t]) {
    const Coupling& coupling = couplings_[index];
    const auto J = coupling.at.J.middleCols(k * n_, n_);
    for (int i = 0; i < n_; ++i) {
      for (Eigen::Index row = 0; row < J.rows(); ++row) {
        b[i * b_stride + shared_size() + coupling.first_far_row + row] += J(row, i);
      }
    }
  }
}

void ChainProblem::SumSharedOfCouplings() {
  const int s = shared_size();
  for (const Coupling& coupling : couplings_) {
    for (int i = 0; i < s; ++i) {
      const auto column = coupling.at.J.col(SharedColumnOf(coupling, i));
      shared_gradient_[i] += column.dot(coupling.at.r);
      if (coupling.first_far_row >= 0) {
        far_shared_diagonal_[i] += column.squaredNorm();
        continue;
      }
      for (int j = 0; j <= i; ++j) shared_(i, j) += column.dot(coupling.at.J.col(SharedColumnOf(coupling, j)));
    }
  }
}

Eigen::MatrixXd ChainProblem::Arrow(const Eigen::VectorXd& damping) const {
  const int s = shared_size();
  Eigen::MatrixXd arrow = Eigen::MatrixXd::Zero(arrow_size(), arrow_size());
  arrow.topLeftCorner(s, s) = shared_;
  arrow.diagonal().head(s) += damping;
  for (const Coupling& coupling : couplings_) {
    if (coupling.first_far_row < 0) continue;
    for (int j = 0; j < s; ++j) {
      arrow.col(j).segment(s + coupling.first_far_row, coupling.at.r.size()) =
          coupling.at.J.col(SharedColumnOf(coupling, j));
    }
  }
  arrow.diagonal().tail(num_far_rows_).setConstant(-1);
  return arrow;
}

}  // namespace bodyloom
