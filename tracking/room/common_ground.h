// SPDX-License-Identifier: Apache-2.0
/// The plane that several people stand on, and how their sizes relate.
///
/// One view does not show size: a person s times as large and s times as far away looks the same, so every fit holds
/// its person at a stature that was assumed. Feet on one plane tell: scaled about the camera centre by s_i, the
/// standing feet p_ij of person i must lie on it. Sought are up u, the camera's height h above the plane and log s_i:
///   Σ_ij w_ij ρ(((u · p_ij + h / s_i) / σ_ij)²) + Σ_i (log s_i / 0.08)² + ‖(u − u₀) across u₀‖² / 0.06²   → minimum
/// ρ: Geman–McClure, c = 3 (somebody may stand on a beam); σ_ij² = 3 cm² (heels rise) + (u₀ · ray · 12 cm)² (a stance's
/// depth); w_ij = its seconds, at most 1: EstimateGroundPlane()'s. u₀: the verticals of the fits. 8 %: adults' statures
/// spread by 5.4 % about their common mean (the built-in body's first component), and a fit's proportions make a
/// person seem larger or smaller by as much again. Only ratios of sizes are seen, so the common factor is the prior's:
/// 1. Ceres solves it, from two starts because ρ has plateaus: the plane through everybody's median height, and all of
/// size 1; the lower cost counts.
///
/// Left out, one after the other, and of size 1: whoever stands for less than 0.4 s in all; whoever would have to be
/// off by more than 3 × 8 % (they stand on something else); whoever is not on the plane for half of their standing
/// time. Nothing is said of sizes when fewer than two people are left, and when the camera is within 3 cm / 8 % = 0.38
/// m of the plane: there a raised heel looks like another size.
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
  bool size_known = false;  ///< then s stays 1
};

struct CommonGroundOptions {
  double size_sigma = 0.08;  ///< σ of log s; 0: all sizes are known
};

struct CommonGround {
  bool found = false;        ///< two people or more stand on one plane for the most of everybody's standing time
  std::string why;           ///< what was found, or why nothing
  KnownGround ground;        ///< valid when found
  std::vector<double> size;  ///< s of each person; 1 where nothing was seen of it
  std::vector<char> stands;  ///< of each person: 1 when not left out
};

/// `up`: unit. Throws std::invalid_argument when it is not.
CommonGround FindCommonGround(const std::vector<StandingPerson>& people, const Eigen::Vector3d& up,
                              const CommonGroundOptions& options = {});

// A foot that stands on a plane that several people share:
// r = (u · p + h e^{−x}) / σ
// p: place of the foot on the floor in its person's own fit, camera axes, metres. A person who is e^x times as large,
// seen as large, is e^x times as far away: the foot is at e^x p, and on the plane {q : u · q = −h} when r = 0. It is
// divided by e^x, because σ is of p. Parameters: u (3, unit, up), h (1, camera above the plane, metres), x (1).

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
