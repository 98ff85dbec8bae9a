// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/track_options.h"

#include "geometry/base/check.h"

namespace bodyloom {

bool TrackSequenceOptions::IsValid(std::string* why) const {
  if (num_threads < 0 || num_threads > 256) {
    *why = "num_threads is " + std::to_string(num_threads) + ", expected 0 (all cores) to 256";
    return false;
  }
  if (max_iterations < 1) {
    *why = "max_iterations is " + std::to_string(max_iterations) + ", expected at least 1";
    return false;
  }
  if (!(initialiser_weight >= 0)) {
    *why = "initialiser_weight is " + std::to_string(initialiser_weight) + ", expected 0 or more";
    return false;
  }
  const InRange in_range(why);
  if (!in_range("function_tolerance", function_tolerance, 0, 1) || !in_range("lifter_weight", lifter_weight, 0, 1e6) ||
      !in_range("lifter_min_sigma_m", lifter_min_sigma_m, 1e-6, 1e3) ||
      !in_range("straight_knees_weight", straight_knees_weight, 0, 1e6) ||
      !in_range("velocity_weight", velocity_weight, 0, 1e6) ||
      !in_range("ground.contact_weight", ground.contact_weight, 0, 1e6) ||
      !in_range("ground.sigma_height_m", ground.sigma_height_m, 1e-4, 1e3) ||
      !in_range("ground.sigma_slide_m", ground.sigma_slide_m, 1e-4, 1e3) ||
      !in_range("ground.surface_weight", ground.surface_weight, 0, 1e6) ||
      !in_range("ground.hold_weight", ground.hold_weight, 0, 1e6) ||
      !in_range("ground.balance_weight", ground.balance_weight, 0, 1e6) ||
      !in_range("rendered_uv.weight", rendered_uv.weight, 0, 1e6) ||
      !in_range("rendered_uv.max_points", rendered_uv.max_points, 1, 1e7) ||
      !in_range("rendered_uv.rounds", rendered_uv.rounds, 0, 100) ||
      !in_range("rendered_uv.max_iterations", rendered_uv.max_iterations, 1, 1000) ||
      !in_range("rendered_uv.min_cosine", rendered_uv.min_cosine, 1e-3, 1) ||
      !in_range("part_labels.silhouette_weight", part_labels.silhouette_weight, 0, 1e6) ||
      !in_range("part_labels.part_weight", part_labels.part_weight, 0, 1e6) ||
      !in_range("part_labels.sigma_share", part_labels.sigma_share, 1e-4, 1) ||
      !in_range("part_labels.clothes_sigma_share", part_labels.clothes_sigma_share, 0, 1) ||
      !in_range("part_labels.start_kernel", part_labels.start_kernel, 0.1, 1e6) ||
      !in_range("part_labels.kernel", part_labels.kernel, 0.1, 1e6) ||
      !in_range("part_labels.rounds", part_labels.rounds, 1, 100) ||
      !in_range("part_labels.max_iterations", part_labels.max_iterations, 1, 1000)) {
    return false;
  }
  return true;
}

std::string ToString(SequenceSolver solver) {
  switch (solver) {
    case SequenceSolver::kCeres:
      return "ceres";
    case SequenceSolver::kChain:
      return "chain";
    case SequenceSolver::kChainThenCeres:
      return "chain+ceres";
  }
  return "";
}

SequenceSolver SequenceSolverFromString(const std::string& word) {
  for (const auto solver : {SequenceSolver::kCeres, SequenceSolver::kChain, SequenceSolver::kChainThenCeres}) {
    if (word == ToString(solver)) return solver;
  }
  BODYLOOM_CHECK(false, "solver '", word, "' is unknown; expected 'chain+ceres', 'ceres' or 'chain'");
  return SequenceSolver::kChainThenCeres;
}

std::string ToString(SolveStatus status) {
  switch (status) {
    case SolveStatus::kFailure:
      return "failure";
    case SolveStatus::kConverged:
      return "converged";
    case SolveStatus::kMaxIterations:
      return "max_iterations";
    case SolveStatus::kStopped:
      return "stopped";
  }
  return "failure";
}

}  // namespace bodyloom
