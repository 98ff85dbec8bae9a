// SPDX-License-Identifier: Apache-2.0
#include "geometry/uv_maps/velocity_stencil.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

double MedianStep(std::span<const double> timestamps) {
  std::vector<double> steps;
  for (size_t t = 1; t < timestamps.size(); ++t) steps.push_back(timestamps[t] - timestamps[t - 1]);
  if (steps.empty()) return 0;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  return steps[steps.size() / 2];
}

/// Frames on each side of the one in the middle.
int HalfWindow(const VelocityStencilOptions& options, double step_s) {
  if (options.scheme != VelocityScheme::kSavitzkyGolay) return 1;
  const double wanted = step_s > 0 ? std::round(0.5 * options.window_s / step_s) : 0;
  return std::max((options.order + 2) / 2, static_cast<int>(std::min(wanted, 1000.0)));
}

}  // namespace

bool VelocityStencilOptions::IsValid(std::string* why) const {
  if (!(window_s > 0) || !(window_s <= 10)) {
    *why = Concatenate("window_s is ", window_s, ", expected more than 0 and at most 10 s");
    return false;
  }
  if (order < 1 || order > 5) {
    *why = Concatenate("order is ", order, ", expected 1..5");
    return false;
  }
  if (!(longest_step_s >= 0) || std::isinf(longest_step_s)) {
    *why = Concatenate("longest_step_s is ", longest_step_s, ", expected 0 or a time in seconds");
    return false;
  }
  return true;
}

double VelocityStencil::NoiseGain() const {
  double sum = 0;
  for (double w : weights) sum += w * w;
  return std::sqrt(sum);
}

std::vector<double> DerivativeWeights(std::span<const double> times, double at, int degree) {
  const auto n = static_cast<Eigen::Index>(times.size());
  BODYLOOM_CHECK(degree >= 1 && n > degree, "a derivative by degree ", degree, " from ", n,
                 " values, expected at least ", degree + 1);
  // Times in units of the window, so that powers of them are of one size.
  const double unit = std::max(std::abs(times.front() - at), std::abs(times.back() - at));
  Eigen::MatrixXd powers(n, degree + 1);
  for (Eigen::Index k = 0; k < n; ++k) {
    powers(k, 0) = 1;
    for (int p = 1; p <= degree; ++p) powers(k, p) = powers(k, p - 1) * (times[k] - at) / unit;
  }
  // Row 1 of the pseudo-inverse: the coefficient of the first power.
  const Eigen::MatrixXd inverse = powers.householderQr().solve(Eigen::MatrixXd::Identity(n, n));
  std::vector<double> weights(times.size());
  for (Eigen::Index k = 0; k < n; ++k) weights[k] = inverse(1, k) / unit;
  return weights;
}

std::vector<VelocityStencil> VelocityStencils(std::span<const double> timestamps, std::span<const char> usable,
                                              const VelocityStencilOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "velocities: ", why);
  BODYLOOM_CHECK(timestamps.size() == usable.size(), "velocities: ", timestamps.size(), " timestamps for ",
                 usable.size(), " frames");
  const int T = static_cast<int>(timestamps.size());
  for (int t = 0; t < T; ++t) {
    BODYLOOM_CHECK(std::isfinite(timestamps[t]), "velocities: frame ", t, " has the time ", timestamps[t]);
    BODYLOOM_CHECK(t == 0 || timestamps[t] > timestamps[t - 1], "velocities: frame ", t, " is at ", timestamps[t],
                   " s after ", timestamps[t - 1], " s, expected times to grow");
  }
  const double step = MedianStep(timestamps);
  const double longest_step = options.longest_step_s > 0 ? options.longest_step_s : 1.5 * step;
  const int half = HalfWindow(options, step);

  std::vector<VelocityStencil> stencils(T);
  int segment = 0;
  for (int begin = 0, end = 0; begin < T; begin = end) {
    end = begin + 1;
    if (!usable[begin]) continue;
    while (end < T && usable[end] && timestamps[end] - timestamps[end - 1] <= longest_step) ++end;
    for (int t = begin; t < end; ++t) {
      VelocityStencil& stencil = stencils[t];
      stencil.segment = segment;
      if (end - begin == 1) continue;
      const bool backward = options.scheme == VelocityScheme::kBackward;
      const int count = std::min(end - begin, backward ? 2 : 2 * half + 1);
      stencil.first_frame = std::clamp(backward ? t - 1 : t - half, begin, end - count);
      const int degree = backward ? 1 : options.scheme == VelocityScheme::kCentral ? 2 : options.order;
      stencil.weights =
          DerivativeWeights(timestamps.subspan(stencil.first_frame, count), timestamps[t], std::min(degree, count - 1));
    }
    ++segment;
  }
  return stencils;
}

}  // namespace bodyloom
