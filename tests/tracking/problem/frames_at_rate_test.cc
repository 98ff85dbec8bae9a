// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tracking/problem/sequence_problem.h"

namespace bodyloom::frames_at_rate_test {
namespace {

SequenceProblem Clip(int frames, double fps, const std::vector<int>& cuts = {}) {
  SequenceProblem problem;
  problem.states.resize(size_t(frames));
  problem.cut_before.assign(size_t(frames), 0);
  for (int t = 0; t < frames; ++t) problem.timestamps.push_back(t / fps);
  for (const int t : cuts) problem.cut_before[size_t(t)] = 1;
  return problem;
}

std::vector<char> Flags(int frames, const std::vector<int>& set) {
  std::vector<char> flags(size_t(frames), 0);
  for (const int t : set) flags[size_t(t)] = 1;
  return flags;
}

TEST(FramesAtRate, KeepsTheEndsOfShots) {
  EXPECT_EQ(FramesAtRate(Clip(8, 30), 15), (std::vector<int>{0, 2, 4, 6, 7}));
  EXPECT_EQ(FramesAtRate(Clip(8, 30, {3}), 15), (std::vector<int>{0, 2, 3, 5, 7}));
  EXPECT_EQ(FramesAtRate(Clip(4, 10), 15), (std::vector<int>{0, 1, 2, 3}));
}

TEST(FramesAtRate, TheFirstAnchorOfAShotSetsThePhase) {
  EXPECT_EQ(FramesAtRate(Clip(8, 30), 15, Flags(8, {1, 3, 5})), (std::vector<int>{0, 1, 3, 5, 7}));
  EXPECT_EQ(FramesAtRate(Clip(8, 30), 15, Flags(8, {3, 5})), (std::vector<int>{0, 2, 3, 5, 7}));
  EXPECT_EQ(FramesAtRate(Clip(8, 30), 15, Flags(8, {0, 2, 4})), FramesAtRate(Clip(8, 30), 15));
  EXPECT_EQ(FramesAtRate(Clip(8, 30), 15, Flags(8, {})), FramesAtRate(Clip(8, 30), 15)) << "no anchor";
  EXPECT_EQ(FramesAtRate(Clip(12, 30, {5}), 15, Flags(12, {1, 6})), (std::vector<int>{0, 1, 3, 4, 5, 6, 8, 10, 11}))
      << "each shot has its own";
}

}  // namespace
}  // namespace bodyloom::frames_at_rate_test
