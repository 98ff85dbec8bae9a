// SPDX-License-Identifier: Apache-2.0
#include "pipelines/live/live_state.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bodyloom::live_delays_test {
namespace {

TEST(DelayCounts, PercentilesToAMillisecond) {
  DelayCounts delays;
  EXPECT_TRUE(std::isnan(delays.Percentiles().median));
  for (int i = 0; i < 1000; ++i) delays.Add((i * 7) % 1000 / 10.0);  // 0 to 99.9, in another order
  const DelayPercentiles found = delays.Percentiles();
  EXPECT_NEAR(found.median, 50, 1);
  EXPECT_NEAR(found.p95, 95, 1);
  EXPECT_NEAR(found.p99, 99, 1);
  EXPECT_EQ(found.most, 99.9);
}

TEST(DelayCounts, ExtremesAreKeptWithinBounds) {
  DelayCounts delays;
  delays.Add(-5);
  delays.Add(1e9);
  EXPECT_EQ(delays.Percentiles().median, 0.5);
  EXPECT_EQ(delays.Percentiles().p99, 19'999.5);
  EXPECT_EQ(delays.Percentiles().most, 1e9);
  EXPECT_EQ(ToText(delays.Percentiles()).rfind("0 ms in half of the frames", 0), 0U) << ToText(delays.Percentiles());
}

}  // namespace
}  // namespace bodyloom::live_delays_test
