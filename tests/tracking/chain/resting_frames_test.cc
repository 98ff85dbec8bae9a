// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/chain/resting_frames.h"

#include <gtest/gtest.h>

namespace bodyloom {
namespace {

using Eigen::VectorXd;

constexpr int kFrames = 40, kValues = 3;

/// A step along which frame t promises promises[t], half of it by the gradient.
void Try(const VectorXd& promises, RestingFrames* rest) {
  VectorXd gradient = VectorXd::Zero(kFrames * kValues), damping = gradient, step = gradient;
  for (int t = 0; t < kFrames; ++t) {
    step[3 * t + 1] = 1;
    gradient[3 * t + 1] = t % 2 == 0 ? -promises[t] : promises[t];
    damping[3 * t + 1] = promises[t];
  }
  rest->Tried(gradient, damping, step, kValues);
}

std::vector<int> Moving(const RestingFrames& rest) {
  std::vector<int> moving;
  for (int t = 0; t < kFrames; ++t) {
    if (!rest.any() || rest.frames()[t] == 0) moving.push_back(t);
  }
  return moving;
}

VectorXd Little(double little) { return VectorXd::Constant(kFrames, little); }

TEST(RestingFrames, ThoseThatPromiseLeastRestAndNeighboursMoveAlong) {
  RestingFrames rest(0.05);
  VectorXd promises = Little(0.01);
  promises[20] = 100;
  Try(promises, &rest);
  EXPECT_FALSE(rest.any()) << "before the step was taken";
  rest.Taken(promises.sum(), 1e-9);
  EXPECT_EQ(Moving(rest), (std::vector<int>{16, 17, 18, 19, 20, 21, 22, 23, 24}));
  EXPECT_NEAR(rest.moving_share(), 9.0 / kFrames, 1e-12);
}

TEST(RestingFrames, MoreRestAsTheOthersArriveAndAllMoveOnTheSameLevel) {
  RestingFrames rest(0.05);
  VectorXd promises = Little(0.01);
  promises[5] = 50, promises[30] = 100;
  Try(promises, &rest);
  rest.Taken(promises.sum(), 1e-9);
  EXPECT_EQ(Moving(rest).size(), 19U) << "frame 0 is too short a rest";
  promises[5] = 0.02, promises[30] = 40;
  Try(promises, &rest);
  rest.Taken(40, 1e-9);
  EXPECT_EQ(Moving(rest).size(), 9U);
  promises[30] = 0.5;  // the 31 others promised 0.32
  Try(promises, &rest);
  rest.Taken(0.5, 1e-9);
  EXPECT_FALSE(rest.any());
  EXPECT_EQ(rest.moving_share(), 1);
}

TEST(RestingFrames, WhatIsBelowTheToleranceWaitsForTheOthersToSettle) {
  RestingFrames rest(0.05);
  VectorXd promises = Little(0.001);
  promises[20] = 100;
  Try(promises, &rest);
  rest.Taken(100, 1);
  promises[20] = 0.001;
  Try(promises, &rest);
  rest.Taken(0.001, 1);
  EXPECT_TRUE(rest.any());
  rest.Clear();
  EXPECT_EQ(Moving(rest).size(), size_t{kFrames});
}

TEST(RestingFrames, AChainThatMovesAllOverIsNotDivided) {
  RestingFrames even(0.05), off(0);
  for (RestingFrames* rest : {&even, &off}) {
    Try(Little(1), rest);
    rest->Taken(kFrames, 1e-9);
    EXPECT_FALSE(rest->any());
  }
  VectorXd promises = Little(0);
  promises[3] = 1;
  Try(promises, &off);
  off.Taken(1, 1e-9);
  EXPECT_FALSE(off.any());
}

}  // namespace
}  // namespace bodyloom
