// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/term_costs.h"

#include <algorithm>
#include <array>
#include <utility>

#include "geometry/base/parallel.h"
#include "geometry/math/rotation.h"
#include "tracking/problem/frame_cost.h"
#include "tracking/solvers/residuals/acceleration_cost.h"

namespace bodyloom {

using Eigen::Array3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kStretch_s = 1;

class CostTable {
 public:
  explicit CostTable(const SequenceProblem& problem) : problem_(problem), T_(problem.states.size()) {}

  TermCosts& Of(const std::string& term) {
    for (TermCosts& costs : table_) {
      if (costs.term == term) return costs;
    }
    TermCosts& added = table_.emplace_back();
    added.term = term;
    added.of_frame = VectorXd::Zero(static_cast<Eigen::Index>(T_));
    return added;
  }
  void AddShared(const std::string& term, double cost) {
    if (table_.empty() || table_.back().term != term) table_.emplace_back().term = term;
    table_.back().cost += cost;
  }

  void AddFrames(int num_threads, FrameResiduals* residuals) {
    std::vector<std::vector<double>> costs(T_);
    std::vector<FrameResiduals> of_frame(residuals == nullptr ? 0 : T_);
    ParallelFor(static_cast<int>(T_), num_threads, [&](int t) {
      thread_local FrameEvaluator evaluator;
      FrameSystem system;
      evaluator.Evaluate(problem_.layout, problem_.frames[t], problem_.states[t], problem_, false, &system,
                         residuals == nullptr ? nullptr : &of_frame[t], &costs[t]);
    });
    for (size_t t = 0; t < T_; ++t) {
      size_t i = 0;
      problem_.frames[t].ForEachTerm([&](const FrameTerm* term, int view) {
        const double cost = costs[t][i++];
        if (!term->is_empty()) Of(NameOfTerm(*term, view)).of_frame[static_cast<Eigen::Index>(t)] += cost;
      });
    }
    for (const FrameResiduals& frame : of_frame) {
      for (const auto& [term, pixels] : frame) {
        PixelResiduals& all = (*residuals)[term];
        all.px.insert(all.px.end(), pixels.px.begin(), pixels.px.end());
        all.unmatched += pixels.unmatched;
      }
    }
  }

  void AddCouplings() {
    UserResidual residual;
    for (const FrameCoupling& coupling : problem_.couplings) {
      std::vector<const FrameState*> states;
      for (const int t : coupling.frames) states.push_back(&problem_.states[t]);
      EvaluateUserCost(coupling.cost, problem_.layout, states, problem_.betas, problem_.log_focal, false, &residual);
      Of(coupling.cost.inputs->term).of_frame[coupling.frames.back()] +=
          0.5 * EvaluateLoss(coupling.cost, residual.r.squaredNorm()).rho;
    }
  }

  void AddSmoothness() {
    if (T_ < 3) return;
    VectorXd& of_frame = Of("smoothness").of_frame;
    const std::vector<int> shot = ShotOfFrames(problem_.cut_before);
    Sigmas sigmas;
    for (size_t t = 2; t < T_; ++t) {
      if (problem_.cut_before[t] || problem_.cut_before[t - 1]) continue;
      if (shot[t] != sigmas.shot) {
        sigmas = {JointAccelerationSigma(problem_, shot[t]), RootAccelerationSigma(problem_, shot[t]), shot[t]};
      }
      const auto factors = AccelerationFactors::Of(problem_.timestamps[t - 1] - problem_.timestamps[t - 2],
                                                   problem_.timestamps[t] - problem_.timestamps[t - 1]);
      double sum = 0;
      const auto add = [&](const Vector3d& before, const Vector3d& after, const Array3d& sigma) {
        sum += ((factors.later * after - factors.earlier * before).array() / sigma).square().sum();
      };
      for (const int j : problem_.layout.active_joints) {
        add(Turn(j, t - 1), Turn(j, t), Array3d::Constant(sigmas.joint[j]));
      }
      add(Move(t - 1), Move(t), Eigen::Map<const Array3d>(sigmas.root.data()));
      of_frame[static_cast<Eigen::Index>(t)] = 0.5 * sum;
    }
  }

  void AddVelocities() {
    if (problem_.velocity_weight <= 0) return;
    VectorXd& of_frame = Of("velocity").of_frame;
    const std::vector<double> joint = JointVelocitySigma(problem_);
    const std::array<double, 3> root = RootVelocitySigma(problem_);
    for (size_t t = 1; t < T_; ++t) {
      if (problem_.cut_before[t]) continue;
      const double dt = problem_.timestamps[t] - problem_.timestamps[t - 1];
      double sum = (Move(t).array() / Eigen::Map<const Array3d>(root.data())).square().sum();
      for (const int j : problem_.layout.active_joints) sum += Turn(j, t).squaredNorm() / (joint[j] * joint[j]);
      of_frame[static_cast<Eigen::Index>(t)] = 0.5 * sum / (dt * dt);
    }
  }

  void AddSharedPriors() {
    const int B = problem_.layout.num_betas;
    if (B > 0) {
      RowMatrixXd A;
      VectorXd b;
      ShapePriorRows(problem_, &A, &b);
      const VectorXd r = A * problem_.betas + b;
      AddShared("shape prior", 0.5 * r.head(B).squaredNorm());
      AddShared("stature", 0.5 * r[B] * r[B]);
    }
    for (const SharedPrior& prior : SharedPriors(problem_, problem_)) {
      const double r = (prior.value - prior.mean) / prior.sigma;
      AddShared(prior.term, 0.5 * r * r);
    }
  }

  std::vector<TermCosts> Take() {
    for (TermCosts& costs : table_) {
      for (const double cost : costs.of_frame) costs.cost += cost;
    }
    return std::move(table_);
  }

 private:
  struct Sigmas {
    std::vector<double> joint;
    std::array<double, 3> root{};
    int shot = -1;
  };
  [[nodiscard]] Vector3d Turn(int joint, size_t t) const {
    const auto& states = problem_.states;
    return AxisAngleFromRotation(states[t - 1].rotations[joint].transpose() * states[t].rotations[joint]);
  }
  [[nodiscard]] Vector3d Move(size_t t) const {
    return problem_.states[t].translation - problem_.states[t - 1].translation;
  }

  const SequenceProblem& problem_;
  size_t T_;
  std::vector<TermCosts> table_;
};

}  // namespace

std::vector<TermCosts> CostsByTerm(const SequenceProblem& problem, int num_threads, FrameResiduals* residuals) {
  CostTable table(problem);
  table.AddFrames(num_threads, residuals);
  table.AddCouplings();
  table.AddSmoothness();
  table.AddVelocities();
  table.AddSharedPriors();
  return table.Take();
}

std::optional<WorstStretch> FindWorstStretch(const std::vector<TermCosts>& costs,
                                             const std::vector<double>& timestamps) {
  const int T = static_cast<int>(timestamps.size());
  if (T == 0 || !(timestamps.back() - timestamps.front() >= 2 * kStretch_s)) return std::nullopt;
  VectorXd of_frame = VectorXd::Zero(T);
  for (const TermCosts& term : costs) {
    if (term.of_frame.size() == T) of_frame += term.of_frame;
  }
  WorstStretch worst;
  double highest = -1;
  double sum = 0;
  for (int begin = 0, end = 0; begin < T; ++begin) {
    for (; end < T && timestamps[end] < timestamps[begin] + kStretch_s; ++end) sum += of_frame[end];
    if (timestamps.back() - timestamps[begin] < kStretch_s * 0.99) break;
    if (sum / (end - begin) > highest) {
      highest = sum / (end - begin);
      worst.begin = begin;
      worst.end = end;
    }
    sum -= of_frame[begin];
  }
  const int count = worst.end - worst.begin;
  worst.begin_s = timestamps[worst.begin];
  worst.end_s = timestamps[worst.end - 1];
  worst.cost_ratio = of_frame.sum() > 0 ? highest * T / of_frame.sum() : 0;
  double max_above = 0;
  for (const TermCosts& term : costs) {
    if (term.of_frame.size() != T) continue;
    const double there = term.of_frame.segment(worst.begin, count).sum();
    const double above = there / count - term.of_frame.sum() / T;
    if (above <= max_above) continue;
    max_above = above;
    worst.term = term.term;
    worst.term_share = there / (highest * count);
  }
  return worst;
}

void SummariseCosts(const SequenceProblem& problem, int num_threads, FrameResiduals* residuals,
                    TrackSequenceSummary* summary) {
  const std::vector<TermCosts> costs = CostsByTerm(problem, num_threads, residuals);
  summary->worst_stretch = FindWorstStretch(costs, problem.timestamps);
  for (const TermCosts& term : costs) summary->costs.push_back({term.term, term.cost});
  std::stable_sort(summary->costs.begin(), summary->costs.end(),
                   [](const TermCost& a, const TermCost& b) { return a.cost > b.cost; });
}

}  // namespace bodyloom
