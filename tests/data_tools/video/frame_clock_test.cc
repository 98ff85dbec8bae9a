// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/frame_decoder.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace bodyloom::frame_clock_test {
namespace {

constexpr double kFrame = 0.04;

std::vector<double> TimesOf(const std::vector<std::optional<int64_t>>& timestamps) {
  FrameClock clock(1, 1000, kFrame);
  std::vector<double> times;
  times.reserve(timestamps.size());
  for (const auto& timestamp : timestamps) times.push_back(clock.Next(timestamp));
  return times;
}

void ExpectTimes(const std::vector<std::optional<int64_t>>& timestamps, const std::vector<double>& expected) {
  const std::vector<double> times = TimesOf(timestamps);
  ASSERT_EQ(times.size(), expected.size());
  for (size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(times[i], expected[i], 1e-12) << "frame " << i;
}

TEST(FrameClock, CountsFromTheFirstFrame) { ExpectTimes({500, 533, 650, 651}, {0, 0.033, 0.15, 0.151}); }

TEST(FrameClock, NegativeTimestampsAreTimestamps) { ExpectTimes({-80, -40, 0}, {0, 0.04, 0.08}); }

TEST(FrameClock, FillsInWhatIsMissing) {
  ExpectTimes({100, std::nullopt, 200, std::nullopt}, {0, kFrame, 0.1, 0.1 + kFrame});
  ExpectTimes({std::nullopt, std::nullopt, 700, 800}, {0, kFrame, 2 * kFrame, 2 * kFrame + 0.1});
}

TEST(FrameClock, AFrameIsNeverBeforeAnother) {
  ExpectTimes({0, 40, 40, 80}, {0, 0.04, 0.04 + kFrame / 2, 0.08});
  ExpectTimes({0, 500, 460, 540}, {0, 0.5, 0.5 + kFrame / 2, 0.54});
}

TEST(FrameClock, GoesOnWhereARecordingBeginsAnew) {
  ExpectTimes({0, 2000, 0, 30, 90}, {0, 2, 2 + kFrame, 2.03 + kFrame, 2.09 + kFrame});
}

TEST(FrameClock, TimestampsAtTheEdgeOfTheirRange) {
  constexpr int64_t kMinimum = std::numeric_limits<int64_t>::min() + 1, kMaximum = std::numeric_limits<int64_t>::max();
  const std::vector<double> times = TimesOf({kMinimum, kMaximum, 0, kMaximum, kMinimum, kMaximum});
  for (size_t i = 1; i < times.size(); ++i) EXPECT_GE(times[i], times[i - 1]);
}

}  // namespace
}  // namespace bodyloom::frame_clock_test
