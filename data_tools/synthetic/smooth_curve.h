// SPDX-License-Identifier: Apache-2.0
/// Smooth functions of time for motion made by code.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

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

/// Passes near its keys (time, value): straight lines between them, constant outside, blurred in time by a smooth
/// window of ±blur_s. Never leaves the range of the keys; twice differentiable.
class SmoothCurve {
 public:
  explicit SmoothCurve(std::vector<std::pair<double, double>> keys, double blur_s = 0.16)
      : keys_(std::move(keys)), blur_s_(blur_s) {}

  [[nodiscard]] double operator()(double t) const {
    constexpr int kHalf = 16;
    double sum = 0, weights = 0;
    for (int k = -kHalf; k <= kHalf; ++k) {
      const double w = Bump(double(k) / (kHalf + 1));
      sum += w * Polyline(t + blur_s_ * k / (kHalf + 1));
      weights += w;
    }
    return sum / weights;
  }

 private:
  [[nodiscard]] double Polyline(double t) const {
    if (t <= keys_.front().first) return keys_.front().second;
    for (size_t i = 1; i < keys_.size(); ++i) {
      const auto& [t_0, v_0] = keys_[i - 1];
      const auto& [t_1, v_1] = keys_[i];
      if (t <= t_1) return v_0 + (v_1 - v_0) * (t - t_0) / (t_1 - t_0);
    }
    return keys_.back().second;
  }

  std::vector<std::pair<double, double>> keys_;
  double blur_s_;
};

}  // namespace bodyloom
