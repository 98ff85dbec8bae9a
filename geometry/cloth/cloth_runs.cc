// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/geometry/cloth/cloth_runs.h"

#include <cmath>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

/// Of ln of a value: friction and, the other way, damping; air density.
constexpr double kApart[kMostClothRuns][2] = {{0, 0}, {0.1, 0.1}, {-0.1, -0.1}, {0.1, -0.1}, {-0.1, 0.1}};

}  // namespace

ClothOptions OfRun(ClothOptions options, int run) {
  BODYLOOM_CHECK(run >= 0 && run < kMostClothRuns, "cloth: run ", run, ", expected 0 to ", kMostClothRuns - 1);
  options.friction *= std::exp(kApart[run][0]);
  options.damping *= std::exp(-kApart[run][0]);
  options.air_density *= std::exp(kApart[run][1]);
  return options;
}

}  // namespace bodyloom
