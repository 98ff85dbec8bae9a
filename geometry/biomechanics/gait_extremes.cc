// SPDX-License-Identifier: Apache-2.0
#include "geometry/biomechanics/gait_extremes.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/percentile.h"

namespace bodyloom {

using Eigen::Vector2d;

namespace {

constexpr double kMinStretch_s = 1, kMaxGapSteps = 2.5, kSlopeHalfWindow_s = 0.5, kMeanHalfWindow_s = 0.05;
constexpr double kClockRounding_s = 1e-6;

/// Indices [first, last] of the times within `half` of the i-th.
std::pair<size_t, size_t> TimesWithin(const std::vector<double>& times, size_t i, double half) {
  const auto first = std::lower_bound(times.begin(), times.end(), times[i] - half - kClockRounding_s);
  const auto end = std::upper_bound(times.begin(), times.end(), times[i] + half + kClockRounding_s);
  return {static_cast<size_t>(first - times.begin()), static_cast<size_t>(end - times.begin()) - 1};
}

std::vector<double> Averaged(const std::vector<double>& times, const std::vector<double>& values) {
  std::vector<double> means;
  for (size_t i = 0; i < values.size(); ++i) {
    auto [first, last] = TimesWithin(times, i, kMeanHalfWindow_s);
    const size_t reach = std::min(i - first, last - i);  // the same on both sides: a slope stays where it is
    double sum = 0;
    for (size_t k = i - reach; k <= i + reach; ++k) sum += values[k];
    means.push_back(sum / double(2 * reach + 1));
  }
  return means;
}

/// Vertex of the parabola through samples i − 1, i, i + 1; the sample's own time at the ends.
double Vertex(const std::vector<double>& times, const std::vector<double>& values, size_t i) {
  if (i == 0 || i + 1 >= values.size()) return times[i];
  const double before = times[i - 1] - times[i], after = times[i + 1] - times[i];
  const double fall_before = (values[i - 1] - values[i]) / before, fall_after = (values[i + 1] - values[i]) / after;
  const double bend = (fall_after - fall_before) / (after - before), slope = fall_before - bend * before;
  return bend < 0 ? times[i] + std::clamp(-slope / (2 * bend), before, after) : times[i];
}

}  // namespace

std::vector<std::pair<size_t, size_t>> KnownStretches(const std::vector<double>& times,
                                                      const std::vector<bool>& known) {
  std::vector<double> steps;
  for (size_t t = 1; t < times.size(); ++t) steps.push_back(times[t] - times[t - 1]);
  const double max_step = kMaxGapSteps * Percentile(steps, 50);
  std::vector<std::pair<size_t, size_t>> stretches;
  size_t begin = 0;
  for (size_t t = 0; t <= times.size(); ++t) {
    const bool goes_on = t < times.size() && known[t] && (t == begin || times[t] - times[t - 1] <= max_step);
    if (goes_on) continue;
    if (t > begin && times[t - 1] - times[begin] >= kMinStretch_s) stretches.emplace_back(begin, t);
    begin = t < times.size() && known[t] ? t : t + 1;
  }
  return stretches;
}

std::vector<Vector2d> LocalSlopes(const std::vector<double>& times, const std::vector<Vector2d>& points) {
  std::vector<Vector2d> slopes;
  for (size_t i = 0; i < points.size(); ++i) {
    const auto [first, last] = TimesWithin(times, i, kSlopeHalfWindow_s);
    double mean = 0;
    for (size_t k = first; k <= last; ++k) mean += times[k] / double(last - first + 1);
    Vector2d sum = Vector2d::Zero();
    double squares = 0;
    for (size_t k = first; k <= last; ++k) {
      sum += (times[k] - mean) * points[k];
      squares += (times[k] - mean) * (times[k] - mean);
    }
    slopes.emplace_back(squares > 0 ? Vector2d(sum / squares) : Vector2d::Zero());
  }
  return slopes;
}

std::vector<Extreme> Maxima(const std::vector<double>& times, const std::vector<double>& values, double swing) {
  std::vector<Extreme> maxima;
  const std::vector<double> smooth = Averaged(times, values);
  if (smooth.empty()) return maxima;
  size_t highest = 0, lowest = 0;
  bool rising = false;  // a swing up from the lowest sample has been seen
  for (size_t i = 1; i < smooth.size(); ++i) {
    if (rising) {
      if (smooth[i] > smooth[highest]) highest = i;
      if (smooth[i] <= smooth[highest] - swing) {
        maxima.push_back({highest, Vertex(times, smooth, highest)});
        rising = false;
        lowest = i;
      }
    } else {
      if (smooth[i] < smooth[lowest]) lowest = i;
      if (smooth[i] >= smooth[lowest] + swing) {
        rising = true;
        highest = i;
      }
    }
  }
  return maxima;
}

}  // namespace bodyloom
