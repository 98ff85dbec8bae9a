// SPDX-License-Identifier: Apache-2.0
// The second of a clip with the worst fit and the dominant term there. The table of costs itself:
// ceres_problem_test.cc.
#include "tracking/solvers/term_costs.h"

#include <gtest/gtest.h>

#include <vector>

namespace bodyloom::term_costs_test {
namespace {

std::vector<double> Times(int frames, double fps) {
  std::vector<double> times;
  for (int t = 0; t < frames; ++t) times.push_back(t / fps);
  return times;
}

TermCosts Costs(const std::string& term, const Eigen::VectorXd& of_frame) { return {term, of_frame, of_frame.sum()}; }

TEST(WorstStretch, IsTheSecondOfTheHighestCost) {
  const int T = 100;
  Eigen::VectorXd even = Eigen::VectorXd::Constant(T, 3), there = Eigen::VectorXd::Zero(T);
  there.segment(50, 20).setConstant(2);  // the whole cost there: 5 a frame, elsewhere 3
  const std::vector<TermCosts> costs = {Costs("even", even), Costs("there", there), {"shared", {}, 1000}};
  const auto worst = FindWorstStretch(costs, Times(T, 20));
  ASSERT_TRUE(worst.has_value());
  EXPECT_EQ(worst->begin, 50);
  EXPECT_EQ(worst->end, 70);
  EXPECT_NEAR(worst->begin_s, 2.5, 1e-12);
  EXPECT_NEAR(worst->end_s, 3.45, 1e-12);
  EXPECT_EQ(worst->term, "there");  // "even" costs more there, and no more than elsewhere
  EXPECT_NEAR(worst->term_share, 2.0 / 5, 1e-12);
  EXPECT_NEAR(worst->cost_ratio, 5 / 3.4, 1e-12);
  EXPECT_EQ(worst->BriefReport(), "2.5 to 3.5 s, at 1.5 times the mean cost: there pulls (40 % of it)");
}

TEST(WorstStretch, ShortClipsHaveNone) {
  const std::vector<TermCosts> costs = {Costs("even", Eigen::VectorXd::Ones(39))};
  EXPECT_FALSE(FindWorstStretch(costs, Times(39, 20)).has_value());
  EXPECT_FALSE(FindWorstStretch({}, {}).has_value());
}

TEST(WorstStretch, GapsInTimeCountByTheClock) {
  // Ten frames in the first second, then one a second: a window of a second holds what lies in it.
  std::vector<double> times = Times(10, 10);
  for (int t = 1; t < 8; ++t) times.push_back(t);
  Eigen::VectorXd costs = Eigen::VectorXd::Ones(17);
  costs[14] = 50;
  const auto worst = FindWorstStretch({Costs("one", costs)}, times);
  ASSERT_TRUE(worst.has_value());
  EXPECT_EQ(worst->begin, 14);
  EXPECT_EQ(worst->end, 15);
  EXPECT_EQ(worst->term, "one");
}

}  // namespace
}  // namespace bodyloom::term_costs_test
