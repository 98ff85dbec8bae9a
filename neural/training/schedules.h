// SPDX-License-Identifier: Apache-2.0
/// Learning rates as functions of the step, 0 … steps − 1.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

/// `rate` for the first half, then a straight line that would reach 0 at `steps`.
inline double LinearDecayOverLastHalf(double rate, int64_t step, int64_t steps) {
  BODYLOOM_CHECK(steps > 0 && step >= 0, "learning rate: step ", step, " of ", steps);
  const double left = 1 - static_cast<double>(step) / static_cast<double>(steps);
  return rate * std::clamp(2 * left, 0.0, 1.0);
}

/// rate · min(1, (step + 1)/warmup) · ½ (1 + cos(π step/steps)).
inline double CosineWithWarmup(double rate, int64_t step, int64_t steps, int64_t warmup_steps) {
  BODYLOOM_CHECK(steps > 0 && step >= 0 && warmup_steps >= 0, "learning rate: step ", step, " of ", steps, ", ",
                 warmup_steps, " to warm up");
  const double warm = std::min(1.0, (static_cast<double>(step) + 1) / std::max<double>(1, double(warmup_steps)));
  const double done = std::min(1.0, static_cast<double>(step) / static_cast<double>(steps));
  return rate * warm * 0.5 * (1 + std::cos(M_PI * done));
}

}  // namespace bodyloom
