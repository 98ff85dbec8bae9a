// SPDX-License-Identifier: Apache-2.0
#include "geometry/base/rate_gate.h"

#include <gtest/gtest.h>

#include <vector>

namespace bodyloom::rate_gate_test {
namespace {

std::vector<char> OfRate(double frames_per_second, int count, double rate) {
  RateGate gate(rate);
  std::vector<char> passes;
  for (int t = 0; t < count; ++t) passes.push_back(gate.Passes(t / frames_per_second) ? 1 : 0);
  return passes;
}

TEST(RateGate, LetsEveryNthFrameOfAVideoPass) {
  EXPECT_EQ(OfRate(30, 7, 15), (std::vector<char>{1, 0, 1, 0, 1, 0, 1}));
  EXPECT_EQ(OfRate(60, 9, 15), (std::vector<char>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
  EXPECT_EQ(OfRate(25, 5, 15), (std::vector<char>{1, 0, 1, 0, 1})) << "never more than the rate";
  EXPECT_EQ(OfRate(10, 3, 15), (std::vector<char>{1, 1, 1}));
  EXPECT_EQ(OfRate(30, 3, 0), (std::vector<char>{1, 1, 1})) << "no rate, no limit";
}

TEST(RateGate, ContinuesFromWhateverPassed) {
  // From a frame that passed on, the past has no influence.
  RateGate from_start(10), from_later(10);
  EXPECT_TRUE(from_start.Passes(0));
  EXPECT_FALSE(from_start.Passes(0.06));
  EXPECT_TRUE(from_start.Passes(0.13));
  EXPECT_TRUE(from_later.Passes(0.13));
  for (double time = 0.14; time < 2; time += 0.0137) EXPECT_EQ(from_start.Passes(time), from_later.Passes(time));
}

TEST(RateGate, ResetActsAsIfTheMomentHadPassed) {
  RateGate gate(10);
  EXPECT_TRUE(gate.Passes(0));
  gate.Reset(0.05);
  EXPECT_FALSE(gate.Passes(0.12));
  EXPECT_TRUE(gate.Passes(0.15));
}

}  // namespace
}  // namespace bodyloom::rate_gate_test
