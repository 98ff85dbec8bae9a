// SPDX-License-Identifier: Apache-2.0
/// Smooth functions of time for procedural motion.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "geometry/base/hash_random.h"

namespace bodyloom {

/// 0 below 0, 1 above 1, between them 6x⁵ − 15x⁴ + 10x³: first and second derivatives vanish at both ends.
inline double SmoothStep(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (x * (6 * x - 15) + 10);
}

/// 1 at 0, 0 outside (−1, 1): (1 − x²)³.
inline double Bump(double x) {
  const double y = std::max(0.0, 1 - x * x);
  return y * y * y;
}

/// Linear interpolation between keys (time, value), constant outside, averaged over ±blur_s with the weight (1 − x²)³:
/// it stays within the range of the keys and has four continuous derivatives. Exact: a polyline is a sum of ramps
/// max(0, t − t_i), and an averaged ramp is a polynomial.
class SmoothCurve {
 public:
  explicit SmoothCurve(const std::vector<std::pair<double, double>>& keys, double blur_s = 0.16)
      : start_(keys.front().second), blur_s_(blur_s) {
    double slope = 0;
    for (size_t i = 0; i < keys.size(); ++i) {
      const double next =
          i + 1 < keys.size() ? (keys[i + 1].second - keys[i].second) / (keys[i + 1].first - keys[i].first) : 0;
      bends_.emplace_back(keys[i].first, next - slope);
      slope = next;
    }
  }

  [[nodiscard]] double operator()(double t) const {
    double value = start_;
    for (const auto& [time, bend] : bends_) value += bend * blur_s_ * SmoothRamp((t - time) / blur_s_);
    return value;
  }

 private:
  /// max(0, x) averaged over ±1: its second derivative is the weight (35/32) (1 − x²)³.
  static double SmoothRamp(double x) {
    if (x <= -1) return 0;
    if (x >= 1) return x;
    const double y = x * x;
    return 35.0 / 256 + 0.5 * x + 35.0 / 32 * y * (0.5 - y * (0.25 - y * (0.1 - y / 56)));
  }

  double start_, blur_s_;
  std::vector<std::pair<double, double>> bends_;  ///< time, change of slope
};

// Random errors that change slowly.

/// One value per time (increasing, seconds), mean 0, variance 1, correlation exp(−Δt/τ): continuous but rough
/// (Ornstein–Uhlenbeck).
std::vector<double> RoughDrift(const std::vector<double>& times_s, double time_constant_s, HashRandom random);

/// One value per time, mean 0, variance about 1, differentiable: a sum of waves with random phases and frequencies
/// spread evenly below 1/(2π) · 2/time_constant_s.
std::vector<double> SmoothDrift(const std::vector<double>& times_s, double time_constant_s, HashRandom random);

}  // namespace bodyloom
