// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/clips/smooth_curve.h"

#include <cmath>

namespace bodyloom {

std::vector<double> RoughDrift(const std::vector<double>& times, double time_constant_s, HashRandom random) {
  std::vector<double> values(times.size());
  for (size_t t = 0; t < times.size(); ++t) {
    const double keep = t == 0 ? 0 : std::exp(-(times[t] - times[t - 1]) / time_constant_s);
    values[t] = (t == 0 ? 0 : keep * values[t - 1]) + std::sqrt(1 - keep * keep) * random.Normal();
  }
  return values;
}

std::vector<double> SmoothDrift(const std::vector<double>& times, double time_constant_s, HashRandom random) {
  constexpr int kWaves = 16;
  std::vector<double> values(times.size(), 0.0);
  for (int k = 0; k < kWaves; ++k) {
    const double omega = 2 / time_constant_s * (k + random.Uniform()) / kWaves;  // rad/s
    const double phase = random.Uniform(0, 2 * M_PI);
    for (size_t t = 0; t < times.size(); ++t) values[t] += std::sqrt(2.0 / kWaves) * std::sin(omega * times[t] + phase);
  }
  return values;
}

}  // namespace bodyloom
