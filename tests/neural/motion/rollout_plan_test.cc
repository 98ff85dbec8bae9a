// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/rollout_plan.h"

#include <gtest/gtest.h>

#include <set>

namespace bodyloom::rollout_plan_test {
namespace {

const std::vector<FrameRange> kRanges = {{10, 30}, {50, 51}, {60, 90}};

TEST(RolloutPlan, RolloutsStayInsideARangeAndEndAfterTheirLength) {
  RolloutPlan plan(kRanges, {.places = 3, .length = 8, .from_truth = 0.5, .seed = 3});
  std::vector<int> before(3, -1), since(3, 0);
  std::set<int> seen;
  int restarts = 0, from_truth = 0;
  for (int step = 0; step < 2000; ++step) {
    const std::vector<RolloutStep> steps = plan.Next();
    ASSERT_EQ(steps.size(), 3U);
    for (int c = 0; c < 3; ++c) {
      const RolloutStep& s = steps[c];
      seen.insert(s.frame);
      if (s.restart) {
        ++restarts;
        from_truth += s.from_truth;
        since[c] = 0;
        // The truth of the frame before must be one to train on.
        EXPECT_FALSE(s.from_truth && (s.frame == 10 || s.frame == 50 || s.frame == 60));
      } else {
        EXPECT_EQ(s.frame, before[c] + 1);
      }
      EXPECT_LT(since[c]++, 8);
      before[c] = s.frame;
    }
  }
  EXPECT_EQ(seen.size(), 51U);
  EXPECT_EQ(*seen.begin(), 10);
  EXPECT_EQ(*seen.rbegin(), 89);
  EXPECT_FALSE(seen.contains(30));
  EXPECT_NEAR(double(from_truth) / restarts, 0.5 * 48 / 51, 0.06);
}

TEST(RolloutPlan, RolloutsTakeTurnsAndDoNotRestartTogether) {
  constexpr int kRollouts = 4, kLength = 8;
  RolloutPlan plan({{0, 1000}}, {.places = 2, .rollouts = kRollouts, .length = kLength, .from_truth = 1, .seed = 5});
  std::vector<std::vector<int>> restarts(kRollouts);
  std::vector<int> before(kRollouts * 2, -1);
  for (int step = 0; step < kRollouts * 40; ++step) {
    const std::vector<RolloutStep> steps = plan.Next();
    ASSERT_EQ(steps.size(), 2U);
    for (int c = 0; c < 2; ++c) {
      const RolloutStep& s = steps[c];
      EXPECT_EQ(s.rollout, step % kRollouts);
      int& last = before[s.rollout * 2 + c];
      if (!s.restart) {
        EXPECT_EQ(s.frame, last + 1);
      }
      EXPECT_FALSE(step < kRollouts && !s.restart);
      last = s.frame;
      if (s.restart && c == 0 && last < 1000 - kLength) restarts[s.rollout].push_back(step / kRollouts);
    }
  }
  // First roll-outs of 8, 6, 4 and 2 frames, eight after that.
  for (int w = 0; w < kRollouts; ++w) {
    ASSERT_GE(restarts[w].size(), 3U);
    EXPECT_EQ(restarts[w][1], kLength * (kRollouts - w) / kRollouts) << w;
    EXPECT_EQ(restarts[w][2], restarts[w][1] + kLength) << w;
  }
}

TEST(RolloutPlan, SkippingIsTheSameAsStepping) {
  const RolloutPlan::Options options{.places = 4, .rollouts = 3, .length = 5, .from_truth = 0.75, .seed = 9};
  RolloutPlan stepped(kRanges, options), skipped(kRanges, options);
  for (int i = 0; i < 37; ++i) stepped.Next();
  skipped.Skip(37);
  for (int i = 0; i < 20; ++i) {
    const auto a = stepped.Next(), b = skipped.Next();
    for (size_t c = 0; c < a.size(); ++c) {
      EXPECT_EQ(a[c].frame, b[c].frame);
      EXPECT_EQ(a[c].rollout, b[c].rollout);
      EXPECT_EQ(a[c].restart, b[c].restart);
      EXPECT_EQ(a[c].from_truth, b[c].from_truth);
    }
  }
}

TEST(RolloutPlan, RefusesEmptyRangesAndNoRollouts) {
  EXPECT_THROW(RolloutPlan({}, {}), std::invalid_argument);
  EXPECT_THROW(RolloutPlan({{5, 5}}, {}), std::invalid_argument);
  EXPECT_THROW(RolloutPlan({{-1, 5}}, {}), std::invalid_argument);
  EXPECT_THROW(RolloutPlan({{0, 5}}, {.rollouts = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::rollout_plan_test
