// SPDX-License-Identifier: Apache-2.0
#include "pipelines/live/live_delays.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "pipelines/report_text.h"

namespace bodyloom {

void DelayCounts::Add(double milliseconds) {
  const auto bin = size_t(std::clamp(milliseconds, 0.0, double(counts_.size() - 1)));
  ++counts_[bin];
  ++total_;
  most_ = std::max(most_, milliseconds);
}

double DelayCounts::At(double share) const {
  if (total_ == 0) return std::numeric_limits<double>::quiet_NaN();
  int64_t below = 0;
  for (size_t bin = 0; bin < counts_.size(); ++bin) {
    below += counts_[bin];
    if (double(below) >= share * double(total_)) return double(bin) + 0.5;
  }
  return most_;
}

std::string ToText(const DelayPercentiles& delay) {
  return Fixed(delay.median, 0) + " ms in half of the frames, " + Fixed(delay.p95, 0) + " in 95 %, " +
         Fixed(delay.p99, 0) + " in 99 %, " + Fixed(delay.most, 0) + " at most";
}

}  // namespace bodyloom
