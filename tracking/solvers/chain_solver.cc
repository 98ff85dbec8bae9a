// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/chain_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/base/stopwatch.h"
#include "tracking/terms/dense/dense.h"

namespace bodyloom {
namespace {

using Eigen::VectorXd;

constexpr double kMinRelativeDecrease = 1e-3, kMinDiagonal = 1e-6, kMaxDiagonal = 1e32;
constexpr double kStartRadius = 1e4, kMaxRadius = 1e16, kMinRadius = 1e-32;
constexpr int kMaxInvalidSteps = 5;
constexpr double kMaxMissedDecrease = 3;  ///< of the tolerance, predicted of a step that ends the descent
/// Minimum count of an iteration, since frozen frames take some time too.
constexpr double kMinIteration = 0.25;
constexpr double kEarlyTolerance = 1e-3;  ///< below it all keypoints are used (ChainOptions::early_dense)

/// The size of the trust region.
class Radius {
 public:
  [[nodiscard]] double value() const { return radius_; }
  void Accepted(double quality) {
    radius_ = std::min(kMaxRadius, radius_ / std::max(1.0 / 3, 1 - std::pow(2 * quality - 1, 3)));
    decrease_ = 2;
  }
  void Rejected() {
    radius_ /= decrease_;
    decrease_ *= 2;
  }

 private:
  double radius_ = kStartRadius, decrease_ = 2;
};

VectorXd ColumnScale(const VectorXd& diagonal) { return (1 + diagonal.array().sqrt()).inverse(); }

/// Λ: clamp(S² h) / (r S²).
VectorXd Damping(const VectorXd& diagonal, const VectorXd& scale, double radius) {
  const Eigen::ArrayXd squared = scale.array().square();
  return (squared * diagonal.array()).cwiseMax(kMinDiagonal).cwiseMin(kMaxDiagonal) / (radius * squared);
}

double LargestOf(const VectorXd& x) { return x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0.0; }

size_t MaxDenseOfFrame(const SequenceProblem& problem) {
  size_t count = 0;
  for (const FrameData& frame : problem.frames) {
    count = std::max(count, frame.Get<DenseTerm>().size());
  }
  return count;
}

}  // namespace

SolveReport DescendChain(ChainProblem* chain_problem, ChainFactor* factor, ChainPoint* point,
                         const SolveOptions& options, bool thinned, const std::vector<char>& held) {
  Stopwatch watch;
  SolveReport report;
  ChainProblem& chain = *chain_problem;
  ChainPoint& x = *point;
  ChainPoint candidate;
  if (thinned) chain.LimitPoints(options.chain.early_dense);
  bool reusing = options.chain.reuse_linearisation > 0;
  chain.ReuseLinearisation(options.chain.reuse_linearisation);
  const auto count = [&]() {
    report.frames_skipped += chain.num_skipped();
    report.frames_evaluated += static_cast<int64_t>(x.states.size()) - chain.num_skipped();
  };
  double cost = chain.Linearise(x);
  count();
  report.seconds_evaluation += watch.Lap();
  report.initial_cost = report.final_cost = cost;
  // Multipliers are held with the shared values, so with multipliers no frames are frozen.
  FrozenFrames frozen(chain.num_far_rows() > 0 ? 0 : options.chain.frozen_share);
  double spent = 0;  // iterations, those of a part of the frames by its size
  const auto freeze = [&](std::vector<char> frames) {
    if (frames.empty()) frames = held;
    for (size_t t = 0; t < held.size(); ++t) frames[t] = frames[t] != 0 || held[t] != 0 ? 1 : 0;
    factor->SetFrozen(frames);
    chain.SetFrozen(std::move(frames));
  };
  const auto finish = [&](SolveStatus status, std::string message) {
    factor->SetFrozen({});
    chain.SetFrozen({});
    report.status = status;
    report.message = std::move(message);
    report.final_cost = cost;
    report.seconds = watch.seconds();
    return report;
  };
  const auto release_all = [&]() {
    if (!frozen.any()) return false;
    cost = chain.Linearise(x);
    report.seconds_evaluation += watch.Lap();
    freeze({});
    frozen.Clear();
    return true;
  };
  // All frames with all their keypoints, evaluated at this point, as the end of the descent requires. False when that
  // changed nothing.
  const auto make_whole = [&]() {
    if (!thinned && !(reusing && chain.num_skipped() > 0)) return false;
    chain.LimitPoints(0);
    if (!thinned) chain.ReuseLinearisation(0);
    reusing = reusing && thinned;
    thinned = false;
    cost = chain.Linearise(x);
    count();
    report.seconds_evaluation += watch.Lap();
    return true;
  };
  report.iterations = 1;
  if (!std::isfinite(cost)) return finish(SolveStatus::kFailure, "the cost is not finite at the start");
  freeze({});
  const VectorXd scale = ColumnScale(chain.diagonal()), shared_scale = ColumnScale(chain.shared_diagonal());
  double x_norm = std::sqrt(chain.SquaredNorm(x));
  Radius radius;
  int invalid_steps = 0;
  bool rejected = false, moved = false,
       fresh = true;  // fresh: the point was reached by an accepted step, or is the first
  for (;; spent += std::max(kMinIteration, frozen.moving_share())) {
    const int iteration = static_cast<int>(spent);
    if (options.on_iteration && !options.on_iteration(iteration, cost)) {
      return finish(SolveStatus::kStopped, "stopped by the caller");
    }
    if (fresh && !frozen.any() &&
        std::max(LargestOf(chain.gradient()), LargestOf(chain.shared_gradient())) <= options.gradient_tolerance) {
      if (!make_whole()) return finish(SolveStatus::kConverged, "the gradient is below its tolerance");
      if (!std::isfinite(cost)) return finish(SolveStatus::kFailure, "the cost of all keypoints is not finite");
    }
    if (iteration >= options.max_iterations) {
      release_all();
      if (thinned || (reusing && !options.chain.reuse_to_the_end)) {
        chain.LimitPoints(0);
        chain.ReuseLinearisation(0);
        cost = chain.Cost(x);
      }
      return finish(SolveStatus::kMaxIterations, Concatenate("still going after ", iteration, " iterations"));
    }
    if (radius.value() < kMinRadius && release_all()) radius = Radius();
    if (radius.value() < kMinRadius) {
      return finish(SolveStatus::kConverged, "the trust region has shrunk to nothing");
    }
    fresh = false;
    ++report.iterations;
    watch.Lap();  // what follows is timed by itself
    const VectorXd damping = Damping(chain.diagonal(), scale, radius.value());
    const VectorXd shared_damping = Damping(chain.shared_diagonal(), shared_scale, radius.value());
    chain.SetDamping(&damping);
    VectorXd step, shared_step, arrow_rhs = VectorXd::Zero(chain.arrow_size());
    arrow_rhs.head(chain.shared_size()) = -chain.shared_gradient();
    const bool solved =
        factor->Solve(chain, chain.Arrow(shared_damping), arrow_rhs, options.num_threads, &step, &shared_step);
    shared_step.conservativeResize(chain.shared_size());  // without multipliers
    report.seconds_linear_solver += watch.Lap();
    // −gᵀδ − ½ δᵀHδ with Hδ = −g − Λδ.
    const double predicted_decrease =
        !solved ? 0.0
                : 0.5 * ((damping.array() * step.array().square()).sum() +
                         (shared_damping.array() * shared_step.array().square()).sum() - chain.gradient().dot(step) -
                         chain.shared_gradient().dot(shared_step));
    if (!(predicted_decrease > 0)) {
      if (release_all()) continue;
      if (++invalid_steps >= kMaxInvalidSteps) {
        return finish(SolveStatus::kFailure,
                      Concatenate(invalid_steps, " steps in a row could not be computed: the system is singular"));
      }
      radius.Rejected();
      continue;
    }
    invalid_steps = 0;
    frozen.Tried(chain.gradient(), damping, step, chain.frame_size());
    chain.Plus(x, step, shared_step, &candidate);
    watch.Lap();  // what follows is timed by itself
    // Most steps are accepted, and the derivatives at the new point cost little once its cost is known: both at once,
    // unless the last step was rejected or this one is predicted to be the last.
    const bool both = !rejected && predicted_decrease > options.function_tolerance * cost;
    const double candidate_cost = both ? chain.Linearise(candidate) : chain.Cost(candidate);
    count();
    report.seconds_evaluation += watch.Lap();
    const double change = cost - candidate_cost;
    const bool too_short = moved && std::sqrt(step.squaredNorm() + shared_step.squaredNorm()) <=
                                        options.parameter_tolerance * (x_norm + options.parameter_tolerance);
    const double tolerance = (thinned ? kEarlyTolerance : options.function_tolerance) * cost;
    // A step that was predicted to gain and did not is too long, not the last. Predictions of reused linearisations say
    // nothing of that.
    const bool converged =
        std::abs(change) <= tolerance && (reusing || predicted_decrease <= kMaxMissedDecrease * tolerance);
    if (too_short || converged) {
      if (change > 0) {
        cost = candidate_cost;
        std::swap(x, candidate);
      }
      if (release_all()) {
        fresh = true;
        rejected = moved = false;
        continue;
      }
      if (!make_whole()) {
        return finish(SolveStatus::kConverged,
                      too_short ? "the step is below its tolerance" : "the change of the cost is below its tolerance");
      }
      if (!std::isfinite(cost)) return finish(SolveStatus::kFailure, "the cost of all keypoints is not finite");
      fresh = true;
      rejected = moved = false;
      radius = Radius();  // reused linearisations may have shrunk it
      continue;
    }
    const double quality = change / predicted_decrease;
    if (!(quality > kMinRelativeDecrease)) {  // also when the candidate's cost is not finite
      if (both) {
        chain.Linearise(x);
        count();
        report.seconds_evaluation += watch.Lap();
      }
      radius.Rejected();
      rejected = true;
      continue;
    }
    std::swap(x, candidate);
    if (!both) {
      watch.Lap();  // what follows is timed by itself
      chain.Linearise(x);
      count();
      report.seconds_evaluation += watch.Lap();
    }
    cost = candidate_cost;
    rejected = false;
    x_norm = std::sqrt(chain.SquaredNorm(x));
    radius.Accepted(quality);
    moved = fresh = true;
    frozen.Taken(predicted_decrease, tolerance);
    freeze(frozen.frames());
  }
}

SolveReport SolveChain(SequenceProblem* problem, const SolveOptions& options, const std::vector<char>& held) {
  Stopwatch watch;
  ChainProblem chain(*problem, options.shape_constant, options.focal_constant, options.num_threads);
  ChainFactor factor(chain.frame_size(), chain.arrow_size(), chain.cut_before(), chain.num_far_rows());
  ChainPoint x(problem->states, *problem);
  const bool thin =
      options.chain.early_dense > 0 && MaxDenseOfFrame(*problem) > 2 * static_cast<size_t>(options.chain.early_dense);
  SolveReport report = DescendChain(&chain, &factor, &x, options, thin, held);
  if (report.status != SolveStatus::kFailure) {
    problem->states = std::move(x.states);
    static_cast<SharedValues&>(*problem) = std::move(x);
  }
  report.seconds = watch.seconds();
  return report;
}

namespace {

/// Frozen frames are released when the predicted decrease of the others falls below this many times theirs …
constexpr double kLevel = 2;
/// … unless that was less than this part of the tolerance.
constexpr double kNegligible = 0.1;
/// Number of frames on each side of a moving one that move too, since smoothness propagates its step.
constexpr Eigen::Index kReach = 4;
/// Maximum length of a run between moving frames that is not frozen (a single frame is not allowed: chain_factor.h).
constexpr Eigen::Index kShortest = 4;
/// Minimum share of frozen frames for which a chain is divided.
constexpr double kWorthwhile = 0.3;

}  // namespace

void FrozenFrames::Clear() {
  frames_.clear();
  frozen_decrease_ = 0;
  moving_share_ = 1;
}

void FrozenFrames::Tried(const Eigen::VectorXd& gradient, const Eigen::VectorXd& damping, const Eigen::VectorXd& step,
                         int n) {
  if (share_ <= 0) return;
  predicted_decreases_.resize(step.size() / n);
  for (Eigen::Index t = 0; t < predicted_decreases_.size(); ++t) {
    if (IsFrozen(t)) continue;
    const auto d = step.segment(t * n, n);
    predicted_decreases_[t] = 0.5 * (std::abs(gradient.segment(t * n, n).dot(d)) +
                                     (damping.segment(t * n, n).array() * d.array().square()).sum());
  }
}

void FrozenFrames::Taken(double predicted_decrease, double tolerance) {
  if (share_ <= 0) return;
  if (frozen_decrease_ > kNegligible * tolerance && predicted_decrease < kLevel * frozen_decrease_) {
    Clear();
  } else {
    Plan(share_ * predicted_decrease);
  }
}

void FrozenFrames::Plan(double more) {
  const Eigen::Index T = predicted_decreases_.size();
  std::vector<std::pair<double, Eigen::Index>> moving;
  for (Eigen::Index t = 0; t < T; ++t) {
    if (!IsFrozen(t)) moving.emplace_back(predicted_decreases_[t], t);
  }
  std::sort(moving.begin(), moving.end());
  std::vector<char> next(T, 1);
  for (const auto& [decrease, t] : moving) {
    more -= decrease;
    if (more >= 0) continue;
    for (Eigen::Index u = std::max<Eigen::Index>(0, t - kReach); u <= std::min(T - 1, t + kReach); ++u) {
      if (!IsFrozen(u)) next[u] = 0;
    }
  }
  for (Eigen::Index begin = 0, t = 0; t <= T; ++t) {
    if (t < T && next[t] != 0) continue;
    if (t - begin < kShortest) std::fill(next.begin() + begin, next.begin() + t, 0);
    begin = t + 1;
  }
  const auto count = static_cast<double>(std::count(next.begin(), next.end(), 1));
  if (count < kWorthwhile * static_cast<double>(T)) return;
  frames_ = std::move(next);
  moving_share_ = 1 - count / static_cast<double>(T);
  frozen_decrease_ = 0;
  for (Eigen::Index t = 0; t < T; ++t) frozen_decrease_ += IsFrozen(t) ? predicted_decreases_[t] : 0;
}

}  // namespace bodyloom
