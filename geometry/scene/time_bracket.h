// SPDX-License-Identifier: Apache-2.0
/// The samples around a moment, for values that are interpolated in time. A header by itself, since views' motions,
/// tracks and detections are all sampled so.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

namespace bodyloom {

/// The value at the moment is (1 − s) of sample `before` and s of sample `after`; at and beyond the last one both are
/// that.
struct TimeBracket {
  int before = 0, after = 0;
  double s = 0;
  double gap_s = 0;  ///< time between the two
};

/// None before the first of the ascending times, and more than `beyond_s` after the last.
inline std::optional<TimeBracket> FindTimeBracket(const std::vector<double>& times, double t, double beyond_s = 1e-9) {
  const auto next = std::upper_bound(times.begin(), times.end(), t) - times.begin();
  if (next == 0 || t > times.back() + beyond_s) return std::nullopt;
  TimeBracket bracket;
  bracket.before = static_cast<int>(next) - 1;
  bracket.after = std::min(bracket.before + 1, static_cast<int>(times.size()) - 1);
  bracket.gap_s = times[bracket.after] - times[bracket.before];
  bracket.s = bracket.gap_s > 0 ? (t - times[bracket.before]) / bracket.gap_s : 0;
  return bracket;
}

}  // namespace bodyloom
