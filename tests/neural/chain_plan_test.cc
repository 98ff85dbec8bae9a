// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/chain_plan.h"

#include <gtest/gtest.h>

#include <set>

namespace bodyloom {
namespace {

const std::vector<FrameRange> kRanges = {{10, 30}, {50, 51}, {60, 90}};

TEST(ChainPlan, WalksStayInsideARangeAndEndAfterTheirLength) {
  ChainPlan plan(kRanges, {.chains = 3, .length = 8, .from_truth = 0.5, .seed = 3});
  std::vector<int> before(3, -1), since(3, 0);
  std::set<int> seen;
  int restarts = 0, from_truth = 0;
  for (int step = 0; step < 2000; ++step) {
    const std::vector<ChainStep> steps = plan.Next();
    ASSERT_EQ(steps.size(), 3U);
    for (int c = 0; c < 3; ++c) {
      const ChainStep& s = steps[c];
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

TEST(ChainPlan, SkippingIsTheSameAsWalking) {
  const ChainPlan::Options options{.chains = 4, .length = 5, .from_truth = 0.75, .seed = 9};
  ChainPlan walked(kRanges, options), skipped(kRanges, options);
  for (int i = 0; i < 37; ++i) walked.Next();
  skipped.Skip(37);
  for (int i = 0; i < 20; ++i) {
    const auto a = walked.Next(), b = skipped.Next();
    for (size_t c = 0; c < a.size(); ++c) {
      EXPECT_EQ(a[c].frame, b[c].frame);
      EXPECT_EQ(a[c].restart, b[c].restart);
      EXPECT_EQ(a[c].from_truth, b[c].from_truth);
    }
  }
}

TEST(ChainPlan, RefusesEmptyRanges) {
  EXPECT_THROW(ChainPlan({}, {}), std::invalid_argument);
  EXPECT_THROW(ChainPlan({{5, 5}}, {}), std::invalid_argument);
  EXPECT_THROW(ChainPlan({{-1, 5}}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom
