// SPDX-License-Identifier: Apache-2.0
/// Delays of live tracking: counts by the millisecond, in bounded memory, and their percentiles.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bodyloom {

/// Percentiles of a delay, ms, to a millisecond.
struct DelayPercentiles {
  double median = 0, p95 = 0, p99 = 0, most = 0;
};

/// "34 ms in half of the frames, 41 in 95 %, 60 in 99 %, 112 at most".
std::string ToText(const DelayPercentiles& delay);

class DelayCounts {
 public:
  /// Delays below 0 count as 0, those from 20 s on as 20 s.
  void Add(double milliseconds);
  /// Middles of the milliseconds that hold these shares, and the largest delay; NaN and 0 before the first.
  [[nodiscard]] DelayPercentiles Percentiles() const { return {At(0.5), At(0.95), At(0.99), most_}; }

 private:
  [[nodiscard]] double At(double share) const;

  std::vector<int64_t> counts_ = std::vector<int64_t>(20'000);
  int64_t total_ = 0;
  double most_ = 0;
};

}  // namespace bodyloom
