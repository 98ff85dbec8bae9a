// SPDX-License-Identifier: Apache-2.0
/// Estimates the plane that several people stand on, and their relative sizes.
///
/// A single view does not determine size: a person s times as large and s times as far away looks the same, so every
/// fit holds its person at an assumed stature. A common ground plane determines relative sizes: scaled about the camera
/// centre by s_i, the standing feet p_ij of person i must lie on it. Unknowns are up u, the camera's height h above the
/// plane and log s_i:
///   Σ_ij w_ij ρ(((u · p_ij + h / s_i) / σ_ij)²) + Σ_i (log s_i / 0.08)² + ‖(u − u₀) across u₀‖² / 0.06²   → minimum
/// ρ: Geman–McClure, c = 3 (somebody may stand on a beam); σ_ij² = 3 cm² (heels rise) + (u₀ · ray · 12 cm)² (a stance's
/// depth); w_ij = its seconds, at most 1: EstimateGroundPlane()'s. u₀: the verticals of the fits. 8 %: adults' statures
/// have a standard deviation of 5.4 % about their common mean (the built-in body's first component), and errors of a
/// fit's proportions add as much again. Only ratios of sizes are observable, so the common factor is the prior's: 1.
/// Solved by Ceres from two starts, because ρ has plateaus: the plane through everybody's median height, and all sizes
/// 1; the solution of lower cost is used.
///
/// People are excluded one after the other, with size 1: those who stand for less than 0.4 s in all; those whose size
/// would differ by more than 3 × 8 % (they stand on something else); those who are not on the plane for half of their
/// standing time. Sizes are not estimated when fewer than two people are left, or when the camera is within 3 cm / 8 %
/// = 0.38 m of the plane, where a raised heel is indistinguishable from another size.
#pragma once

#include <ceres/sized_cost_function.h>
#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

struct StandingPerson {
  std::vector<StandingFoot> stances;
  bool size_known = false;  ///< if true, s is held at 1
};

struct CommonGroundOptions {
  double size_sigma = 0.08;  ///< σ of log s; 0: all sizes are known
};

struct CommonGround {
  bool found = false;        ///< two people or more stand on one plane for most of everybody's standing time
  std::string why;           ///< the evidence, or the reason why none was found
  KnownGround ground;        ///< valid when found
  std::vector<double> size;  ///< s of each person; 1 if not estimated
  std::vector<char> stands;  ///< of each person: 1 if not excluded
};

/// `up`: unit. Throws std::invalid_argument when it is not.
CommonGround FindCommonGround(const std::vector<StandingPerson>& people, const Eigen::Vector3d& up,
                              const CommonGroundOptions& options = {});

// Residual of a standing foot on the common plane:
//   r = (u · p + h e^{−x}) / σ
// p: position of the foot on the floor in its person's own fit, camera axes, metres. A person who is e^x times as large
// at the same image size is e^x times as far away: the foot is at e^x p, and on the plane {q : u · q = −h} when r = 0.
// The distance is divided by e^x, because σ is of p. Parameters: u (3, unit, up), h (1, camera above the plane,
// metres), x (1).

class StanceCost : public ceres::SizedCostFunction<1, 3, 1, 1> {
 public:
  StanceCost(const Eigen::Vector3d& place_m, double sigma_m) : place_m_(place_m), sigma_m_(sigma_m) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Eigen::Vector3d> up(parameters[0]);
    const double height = parameters[1][0], smaller = std::exp(-parameters[2][0]);
    residuals[0] = (up.dot(place_m_) + height * smaller) / sigma_m_;
    if (jacobians == nullptr) return true;
    for (int k = 0; jacobians[0] != nullptr && k < 3; ++k) jacobians[0][k] = place_m_[k] / sigma_m_;
    if (jacobians[1] != nullptr) jacobians[1][0] = smaller / sigma_m_;
    if (jacobians[2] != nullptr) jacobians[2][0] = -height * smaller / sigma_m_;
    return true;
  }

 private:
  Eigen::Vector3d place_m_;
  double sigma_m_;
};

}  // namespace bodyloom
