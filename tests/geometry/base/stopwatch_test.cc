// SPDX-License-Identifier: Apache-2.0
#include "geometry/base/stopwatch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <ctime>
#include <thread>

namespace bodyloom::stopwatch_test {
namespace {

/// Keeps one core busy for so much processor time.
void Work(double seconds) {
  const std::clock_t start = std::clock();
  while (double(std::clock() - start) / CLOCKS_PER_SEC < seconds) {
  }
}

TEST(StageClock, WorkTakesProcessorTimeAndWaitingDoesNot) {
  StageClock times;
  times.Begin("work");
  Work(0.05);
  times.Begin("wait");
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  times.Begin("work");
  Work(0.05);
  times.End();
  times.End();
  ASSERT_EQ(times.seconds().size(), 2U);
  ASSERT_EQ(times.processor_seconds().size(), 2U);
  for (size_t i = 0; i < 2; ++i) EXPECT_EQ(times.processor_seconds()[i].first, times.seconds()[i].first);
  EXPECT_EQ(times.seconds()[0].first, "work");
  EXPECT_GE(times.processor_seconds()[0].second, 0.1);
  EXPECT_GE(times.seconds()[1].second, 0.1);
  EXPECT_LT(times.processor_seconds()[1].second, 0.05);
  EXPECT_GE(times.total(), times.seconds()[0].second + times.seconds()[1].second);
}

}  // namespace
}  // namespace bodyloom::stopwatch_test
