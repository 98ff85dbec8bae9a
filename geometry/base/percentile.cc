// SPDX-License-Identifier: Apache-2.0
#include "geometry/base/percentile.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "geometry/base/check.h"

namespace bodyloom {

std::vector<double> SortedFinite(std::span<const double> values) {
  std::vector<double> sorted;
  sorted.reserve(values.size());
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted), [](double v) { return std::isfinite(v); });
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

double SortedPercentile(std::span<const double> sorted, double percent) {
  BODYLOOM_CHECK(percent >= 0 && percent <= 100, "Percentile: ", percent, " is outside 0..100");
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double position = static_cast<double>(sorted.size() - 1) * percent / 100;
  const auto below = static_cast<size_t>(position);
  const size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

double Percentile(std::span<const double> values, double percent) {
  return SortedPercentile(SortedFinite(values), percent);
}

}  // namespace bodyloom
