// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/solve_sequence.h"

#include <ceres/ceres.h>
#include <omp.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "tracking/solvers/ceres_problem.h"
#include "tracking/solvers/chain_solver.h"
#include "tracking/solvers/term_costs.h"

namespace bodyloom {

namespace {

class IterationCallback : public ceres::IterationCallback {
 public:
  explicit IterationCallback(const std::function<bool(int, double)>& f) : f_(f) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& s) override {
    return f_(s.iteration, s.cost) ? ceres::SOLVER_CONTINUE : ceres::SOLVER_TERMINATE_SUCCESSFULLY;
  }

 private:
  const std::function<bool(int, double)>& f_;
};

SolveStatus StatusOf(const ceres::Solver::Summary& summary) {
  switch (summary.termination_type) {
    case ceres::CONVERGENCE:
      return SolveStatus::kConverged;
    case ceres::NO_CONVERGENCE:
      return SolveStatus::kMaxIterations;
    case ceres::USER_SUCCESS:
      return SolveStatus::kStopped;
    default:
      return SolveStatus::kFailure;
  }
}

SolveReport SolveFrames(int begin, int end, bool shared_constant, const SolveOptions& options,
                        SequenceProblem* problem) {
  CeresProblem ceres_problem(*problem,
                             {.num_threads = options.num_threads, .begin = begin, .end = end, .compress_frames = true});
  const auto hold = [&](bool constant, double* block) {
    if (constant && block != nullptr) ceres_problem.problem().SetParameterBlockConstant(block);
  };
  hold(shared_constant || options.shape_constant, ceres_problem.betas());
  hold(shared_constant || options.focal_constant, ceres_problem.log_focal());
  for (double* block : ceres_problem.view_blocks()) hold(shared_constant, block);
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  solver.max_num_iterations = options.max_iterations;
  solver.num_threads = 1;  // FrameBatch has the threads
  solver.function_tolerance = options.function_tolerance;
  solver.gradient_tolerance = options.gradient_tolerance;
  solver.parameter_tolerance = options.parameter_tolerance;
  solver.logging_type = ceres::SILENT;
  std::unique_ptr<IterationCallback> callback;
  if (options.on_iteration) {
    callback = std::make_unique<IterationCallback>(options.on_iteration);
    solver.callbacks.push_back(callback.get());
  }
  ceres::Solver::Summary summary;
  const SerialOpenMp no_threads_in_the_factorisation;
  ceres::Solve(solver, &ceres_problem.problem(), &summary);
  SolveReport report;
  report.status = StatusOf(summary);
  report.iterations = static_cast<int>(summary.iterations.size());
  report.initial_cost = summary.initial_cost;
  report.final_cost = summary.final_cost;
  report.seconds = summary.total_time_in_seconds;
  report.message = summary.message;
  report.seconds_evaluation = summary.residual_evaluation_time_in_seconds + summary.jacobian_evaluation_time_in_seconds;
  report.seconds_linear_solver = summary.linear_solver_time_in_seconds;
  if (!summary.iterations.empty()) report.gradient_max_norm = summary.iterations.back().gradient_max_norm;
  if (summary.IsSolutionUsable()) ceres_problem.CopyTo(problem);
  return report;
}

double CostOf(const SequenceProblem& problem, int num_threads) {
  double cost = 0;
  for (const TermCosts& term : CostsByTerm(problem, num_threads)) cost += term.cost;
  return cost;
}

/// Frames that a user's term couples may be in different windows.
bool SolvesInWindows(const SequenceProblem& problem, const SolveOptions& options) {
  const int T = static_cast<int>(problem.states.size()), size = options.max_frames_at_once;
  return size > 2 * kWindowOverlap && T > size && problem.couplings.empty();
}

void AddTimes(const SolveReport& part, SolveReport* whole) {
  whole->iterations += part.iterations;
  whole->seconds += part.seconds;
  whole->seconds_evaluation += part.seconds_evaluation;
  whole->seconds_linear_solver += part.seconds_linear_solver;
  whole->frames_evaluated += part.frames_evaluated;
  whole->frames_skipped += part.frames_skipped;
}

/// Solves overlapping windows one after the other, each from the states that the one before has left. The frames next
/// to a window are held constant and coupled to it by smoothness, so there is no seam, and every window lowers the cost
/// of the whole. Shape, focal length and the other views are held. The costs are sums over the windows, so that frames
/// of two windows count twice.
SolveReport SolveInWindows(const SolveOptions& options, const std::function<SolveReport(int begin, int end)>& solve,
                           SequenceProblem* problem) {
  SolveReport report;
  report.status = SolveStatus::kConverged;
  for (const auto& [begin, end] : WindowsOf(static_cast<int>(problem->states.size()), options.max_frames_at_once)) {
    const SolveReport window = solve(begin, end);
    AddTimes(window, &report);
    report.initial_cost += window.initial_cost;
    report.final_cost += window.final_cost;
    report.gradient_max_norm = std::max(report.gradient_max_norm, window.gradient_max_norm);
    report.message = window.message;
    if (window.status == SolveStatus::kConverged) continue;
    report.status = window.status;
    if (window.status != SolveStatus::kMaxIterations) break;
  }
  return report;
}

/// The frames as a problem of their own, cut where they do not follow each other; `frames` ascending. The shots of
/// smoothness are counted from the first frame.
SequenceProblem PartOf(const SequenceProblem& problem, const std::vector<int>& frames) {
  SequenceProblem part = SelectFrames(problem, frames);
  for (size_t i = 1; i < frames.size(); ++i) {
    if (frames[i] != frames[i - 1] + 1) part.cut_before[i] = 1;
  }
  if (problem.smoothness.size() > 1) {
    const std::vector<int> shots = ShotOfFrames(problem.cut_before);
    part.smoothness.clear();
    for (size_t i = 0; i < frames.size(); ++i) {
      if (i == 0 || part.cut_before[i] != 0) part.smoothness.push_back(problem.smoothness[shots[frames[i]]]);
    }
  }
  part.cut_before[0] = 0;
  return part;
}

SolveReport SolveChainWindow(int begin, int end, SolveOptions options, SequenceProblem* problem) {
  SequenceWindow window(*problem, begin, end);
  options.shape_constant = options.focal_constant = true;
  const SolveReport report = SolveChain(&window.part, options, window.held);
  window.PutInto(problem);
  return report;
}

}  // namespace

std::vector<std::pair<int, int>> WindowsOf(int num_frames, int size) {
  BODYLOOM_CHECK(size > kWindowOverlap, "windows of ", size, " frames that share ", kWindowOverlap);
  std::vector<std::pair<int, int>> windows;
  for (int begin = 0; begin == 0 || begin + kWindowOverlap < num_frames; begin += size - kWindowOverlap) {
    windows.emplace_back(begin, std::min(num_frames, begin + size));
  }
  return windows;
}

std::vector<char> StretchesOf(int num_frames, int count) {
  constexpr int kStretch = 50;
  std::vector<char> used(size_t(num_frames), 0);
  const int stretches = std::max(1, count / kStretch);
  for (int i = 0; i < stretches; ++i) {
    const auto begin = static_cast<int>(int64_t{num_frames} * i / stretches);
    std::fill(used.begin() + begin, used.begin() + std::min(num_frames, begin + kStretch), 1);
  }
  return used;
}

SequenceSample::SequenceSample(const SequenceProblem& problem, int count) {
  const std::vector<char> used = StretchesOf(static_cast<int>(problem.states.size()), count);
  for (size_t t = 0; t < used.size(); ++t) {
    if (used[t] != 0) frames.push_back(static_cast<int>(t));
  }
  share = static_cast<double>(frames.size()) / static_cast<double>(used.size());
  part = PartOf(problem, frames);
  const double wider = 1 / std::sqrt(share);
  part.shape_prior.weight *= share;
  part.shape_prior.height_sigma_m *= wider;
  part.log_focal_sigma *= wider;
  for (ViewLayout& view : part.layout.views) {
    for (double* sigma : {&view.log_focal_sigma, &view.log_ratio_sigma, &view.offset_sigma_s, &view.rate_sigma}) {
      *sigma *= wider;
    }
  }
}

SequenceWindow::SequenceWindow(const SequenceProblem& problem, int begin, int end) {
  constexpr int kNeighbours = 2;  // that accelerations couple
  const int T = static_cast<int>(problem.states.size());
  frames.resize(std::min(T, end + kNeighbours) - std::max(0, begin - kNeighbours));
  std::iota(frames.begin(), frames.end(), std::max(0, begin - kNeighbours));
  for (const int t : frames) held.push_back(t < begin || t >= end ? 1 : 0);
  part = PartOf(problem, frames);
}

void SequenceWindow::PutInto(SequenceProblem* problem) {
  for (size_t i = 0; i < frames.size(); ++i) {
    if (held[i] == 0) problem->states[frames[i]] = std::move(part.states[i]);
  }
}

SolveReport SolveSequence(SequenceProblem* problem, const SolveOptions& options) {
  const size_t T = problem->states.size();
  BODYLOOM_CHECK(
      T > 0 && problem->frames.size() == T && problem->timestamps.size() == T && problem->cut_before.size() == T,
      "sequence: ", T, " states, ", problem->frames.size(), " frames, ", problem->timestamps.size(), " timestamps, ",
      problem->cut_before.size(), " cut flags; expected the same number of each");
  BODYLOOM_CHECK(problem->betas.size() == problem->layout.num_betas, "sequence: ", problem->betas.size(),
                 " betas, the layout has ", problem->layout.num_betas);
  if (options.solver == SequenceSolver::kCeres) return SolveWithCeres(problem, options);
  const auto solve_window = [&](int begin, int end) { return SolveChainWindow(begin, end, options, problem); };
  SolveReport chain = SolvesInWindows(*problem, options) ? SolveInWindows(options, solve_window, problem)
                                                         : SolveChain(problem, options, options.held);
  const bool ended = chain.status == SolveStatus::kFailure || chain.status == SolveStatus::kStopped;
  if (options.solver == SequenceSolver::kChain || ended) return chain;
  SolveReport report = SolveWithCeres(problem, options);
  report.iterations += chain.iterations;
  report.initial_cost = chain.initial_cost;
  report.seconds += chain.seconds;
  report.seconds_evaluation += chain.seconds_evaluation;
  report.seconds_linear_solver += chain.seconds_linear_solver;
  report.frames_evaluated = chain.frames_evaluated;
  report.frames_skipped = chain.frames_skipped;
  return report;
}

SolveReport SolveWithCeres(SequenceProblem* problem, const SolveOptions& options) {
  if (!SolvesInWindows(*problem, options)) {
    return SolveFrames(0, static_cast<int>(problem->states.size()), false, options, problem);
  }
  SolveReport report = SolveInWindows(
      options, [&](int begin, int end) { return SolveFrames(begin, end, true, options, problem); }, problem);
  const double decrease = report.initial_cost - report.final_cost;  // of the whole too: the rest is held
  report.final_cost = CostOf(*problem, options.num_threads);
  report.initial_cost = report.final_cost + decrease;
  return report;
}

SerialOpenMp::SerialOpenMp() : levels_(omp_get_max_active_levels()) { omp_set_max_active_levels(0); }
SerialOpenMp::~SerialOpenMp() { omp_set_max_active_levels(levels_); }

}  // namespace bodyloom
