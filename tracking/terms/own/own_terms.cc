// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/terms/own/own_terms.h"

#include <ceres/cost_function.h>

#include <memory>
#include <string>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/tracking/terms/own/neighbours_cost.h"

namespace bodyloom {

namespace {

/// "3, 3, 9"
std::string List(const std::vector<int>& sizes) {
  std::string text;
  for (const int size : sizes) text += (text.empty() ? "" : ", ") + std::to_string(size);
  return text.empty() ? "none" : text;
}

std::vector<int> BlockSizes(const OwnTerm& term) {
  if (term.reads == OwnTerm::Reads::kPose) {
    std::vector<int> sizes(term.translation ? 1 : 0, 3);
    sizes.insert(sizes.end(), term.joints.size(), 9);
    return sizes;
  }
  return std::vector<int>(term.landmarks.size() * (term.reads == OwnTerm::Reads::kNeighbours ? 2 : 1), 3);
}

}  // namespace

void AddOwnTerms(std::span<const OwnTerm> terms, SequenceProblem* problem) {
  const int T = static_cast<int>(problem->frames.size());
  for (size_t i = 0; i < terms.size(); ++i) {
    const OwnTerm& term = terms[i];
    auto blocks = std::make_shared<OwnBlocks>();
    blocks->term = static_cast<int>(i);
    blocks->points = CompileOwnLandmarks(term, *problem->layout.model, problem->layout.num_betas);
    blocks->translation = term.translation;
    blocks->joints = term.joints;
    const std::vector<int> expected = BlockSizes(term);
    const bool pairs = term.reads == OwnTerm::Reads::kNeighbours;
    for (int t = 0; t < T; ++t) {
      if (pairs && (t + 1 == T || problem->cut_before[t + 1] != 0)) continue;
      std::shared_ptr<const ceres::CostFunction> function = term.cost(t);
      if (function == nullptr) continue;
      BODYLOOM_CHECK(function->parameter_block_sizes() == expected && function->num_residuals() > 0, "own term '",
                     term.name, "', frame ", t, ": ", function->num_residuals(), " residuals on parameter blocks of ",
                     List(function->parameter_block_sizes()), "; expected blocks of ", List(expected));
      OwnCostsOfFrame& own = problem->frames[t].own;
      (pairs ? own.with_next : own.costs).push_back({blocks, std::move(function), term.loss});
    }
  }
}

std::vector<PlanEntry> PlanOwnTerms(std::span<const OwnTerm> terms) {
  std::vector<PlanEntry> plan;
  for (const OwnTerm& term : terms) {
    const char* reads = term.reads == OwnTerm::Reads::kPose         ? "on the pose of a frame"
                        : term.reads == OwnTerm::Reads::kNeighbours ? "on landmarks of neighbouring frames"
                                                                    : "on landmarks of a frame";
    plan.push_back({"own term '" + term.name + "'", true, reads});
  }
  return plan;
}

std::vector<OwnTermSummary> SummariseOwnTerms(std::span<const OwnTerm> terms, const SequenceProblem& problem) {
  std::vector<OwnTermSummary> summaries;
  for (const OwnTerm& term : terms) summaries.push_back({term.name, 0, 0});
  if (terms.empty()) return summaries;
  const auto add = [&](const OwnCost& cost, double value) {
    OwnTermSummary& summary = summaries[cost.blocks->term];
    ++summary.num_costs;
    summary.cost += value;
  };
  for (size_t t = 0; t < problem.frames.size(); ++t) {
    const OwnCostsOfFrame& own = problem.frames[t].own;
    for (const OwnCost& cost : own.costs) {
      add(cost, OwnCostAt(cost, problem.layout, problem.states[t], problem.betas));
    }
    if (!HasCostsWithNext(problem, t)) continue;
    for (const OwnCost& cost : own.with_next) {
      NeighboursResidual residual;
      EvaluateNeighbours(cost, problem.layout, problem.states[t], problem.states[t + 1], problem.betas, false,
                         &residual);
      add(cost, 0.5 * EvaluateOwnLoss(cost, residual.r.squaredNorm()).rho);
    }
  }
  return summaries;
}

}  // namespace bodyloom
