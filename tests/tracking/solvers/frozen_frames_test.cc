// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/chain_solver.h"

#include <gtest/gtest.h>

namespace bodyloom::frozen_frames_test {
namespace {

using Eigen::VectorXd;

constexpr int kFrames = 40, kValues = 3;

/// A step along which the predicted decrease of frame t is decreases[t], half of it by the gradient.
void Try(const VectorXd& decreases, FrozenFrames* frozen) {
  VectorXd gradient = VectorXd::Zero(kFrames * kValues), damping = gradient, step = gradient;
  for (int t = 0; t < kFrames; ++t) {
    step[3 * t + 1] = 1;
    gradient[3 * t + 1] = t % 2 == 0 ? -decreases[t] : decreases[t];
    damping[3 * t + 1] = decreases[t];
  }
  frozen->Tried(gradient, damping, step, kValues);
}

std::vector<int> Moving(const FrozenFrames& frozen) {
  std::vector<int> moving;
  for (int t = 0; t < kFrames; ++t) {
    if (!frozen.any() || frozen.frames()[t] == 0) moving.push_back(t);
  }
  return moving;
}

VectorXd Little(double little) { return VectorXd::Constant(kFrames, little); }

TEST(FrozenFrames, LeastPredictedDecreasesAreFrozenAndNeighboursMoveAlong) {
  FrozenFrames frozen(0.05);
  VectorXd decreases = Little(0.01);
  decreases[20] = 100;
  Try(decreases, &frozen);
  EXPECT_FALSE(frozen.any()) << "before the step was taken";
  frozen.Taken(decreases.sum(), 1e-9);
  EXPECT_EQ(Moving(frozen), (std::vector<int>{16, 17, 18, 19, 20, 21, 22, 23, 24}));
  EXPECT_NEAR(frozen.moving_share(), 9.0 / kFrames, 1e-12);
}

TEST(FrozenFrames, MoreAreFrozenAsTheOthersConvergeAndAllReleasedOnTheSameLevel) {
  FrozenFrames frozen(0.05);
  VectorXd decreases = Little(0.01);
  decreases[5] = 50, decreases[30] = 100;
  Try(decreases, &frozen);
  frozen.Taken(decreases.sum(), 1e-9);
  EXPECT_EQ(Moving(frozen).size(), 19U) << "frame 0 alone is too short to freeze";
  decreases[5] = 0.02, decreases[30] = 40;
  Try(decreases, &frozen);
  frozen.Taken(40, 1e-9);
  EXPECT_EQ(Moving(frozen).size(), 9U);
  decreases[30] = 0.5;  // the 31 others had 0.32
  Try(decreases, &frozen);
  frozen.Taken(0.5, 1e-9);
  EXPECT_FALSE(frozen.any());
  EXPECT_EQ(frozen.moving_share(), 1);
}

TEST(FrozenFrames, WhatIsBelowTheToleranceWaitsForTheOthersToConverge) {
  FrozenFrames frozen(0.05);
  VectorXd decreases = Little(0.001);
  decreases[20] = 100;
  Try(decreases, &frozen);
  frozen.Taken(100, 1);
  decreases[20] = 0.001;
  Try(decreases, &frozen);
  frozen.Taken(0.001, 1);
  EXPECT_TRUE(frozen.any());
  frozen.Clear();
  EXPECT_EQ(Moving(frozen).size(), size_t{kFrames});
}

TEST(FrozenFrames, AChainThatMovesAllOverIsNotDivided) {
  FrozenFrames even(0.05), off(0);
  for (FrozenFrames* frozen : {&even, &off}) {
    Try(Little(1), frozen);
    frozen->Taken(kFrames, 1e-9);
    EXPECT_FALSE(frozen->any());
  }
  VectorXd decreases = Little(0);
  decreases[3] = 1;
  Try(decreases, &off);
  off.Taken(1, 1e-9);
  EXPECT_FALSE(off.any());
}

}  // namespace
}  // namespace bodyloom::frozen_frames_test
