// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/roll_out.h"

#include <gtest/gtest.h>

#include "neural/base/image_tensor.h"
#include "tests/support/test_files.h"

namespace bodyloom::rollout_memory_test {
namespace {

using torch::Tensor;

constexpr int kPlaces = 2, kRollouts = 3, kSide = 4;

MotionState Filled(const std::vector<float>& values) {
  const Tensor column = torch::tensor(values).view({-1, 1, 1, 1});
  MotionState state;
  state.labels = column.repeat({1, 7, kSide, kSide});
  state.image = column.repeat({1, 3, kSide, kSide}) + 100;
  return state;
}

MotionBatch Turn(int rollout, std::vector<RolloutStep> steps) {
  MotionBatch batch;
  for (RolloutStep& step : steps) step.rollout = rollout;
  batch.frames.resize(steps.size());
  batch.past.resize(steps.size());
  batch.boxes.assign(steps.size(), {0, 0, kSide, kSide});
  batch.steps = std::move(steps);
  return batch;
}

RolloutMemory Memory(int rollouts = kRollouts) { return {Filled({0}), kPlaces, rollouts}; }

TEST(RolloutMemory, EveryRolloutSeesItsOwnPrediction) {
  RolloutMemory memory = Memory();
  for (int w = 0; w < kRollouts; ++w) {
    memory.Keep(Turn(w, {{}, {}}), Filled({10.0F * static_cast<float>(w) + 1, 10.0F * static_cast<float>(w) + 2}));
  }
  for (const int w : {1, 0, 2}) {
    const MotionState before = memory.Before(Turn(w, {{}, {}}));
    const MotionState expected = Filled({10.0F * static_cast<float>(w) + 1, 10.0F * static_cast<float>(w) + 2});
    EXPECT_TRUE(torch::equal(before.labels, expected.labels)) << w;
    EXPECT_TRUE(torch::equal(before.image, expected.image)) << w;
    EXPECT_FALSE(before.normals.defined());
  }
}

TEST(RolloutMemory, ARestartedRolloutSeesTheTruthOrNothing) {
  RolloutMemory memory = Memory();
  memory.Keep(Turn(1, {{}, {}}), Filled({5, 6}));
  MotionBatch batch = Turn(1, {{.restart = true, .from_truth = true}, {.restart = true}});
  batch.past[0] = Filled({9});
  const MotionState before = memory.Before(batch);
  EXPECT_TRUE(torch::equal(before.labels, Filled({9, 0}).labels));
  EXPECT_TRUE(torch::equal(before.image, Filled({9, 0}).image));
}

TEST(RolloutMemory, ThePastMovesWithTheWindow) {
  RolloutMemory memory = Memory();
  memory.Keep(Turn(0, {{}, {}}), Filled({5, 6}));
  MotionBatch batch = Turn(0, {{}, {}});
  batch.frames[1].before_x = 1, batch.frames[1].before_y = -2;
  const MotionState before = memory.Before(batch), predicted = Filled({5, 6});
  EXPECT_TRUE(torch::equal(before.image[0], predicted.image[0]));
  EXPECT_TRUE(torch::equal(before.image[1], Shifted(predicted.image, 1, -2)[1]));
}

TEST(RolloutMemory, OutsideOfABoxIsBackground) {
  RolloutMemory memory = Memory();
  MotionBatch batch = Turn(1, {{}, {}});
  batch.boxes = {{0, 1, 2, 3}, {2, 2, 4, 4}};
  MotionState predicted = Filled({5, 6});
  for (Tensor* part : predicted.Parts()) *part = part->slice(2, 0, 2).slice(3, 0, 2);
  memory.Keep(batch, predicted);
  const MotionState seen = memory.Before(batch);
  EXPECT_TRUE(torch::equal(seen.image, predicted.image));
  EXPECT_TRUE(torch::equal(seen.labels, predicted.labels));
  const MotionState whole = memory.Before(Turn(1, {{}, {}}));
  EXPECT_EQ(whole.image[0][0][1][1].item<float>(), 105);
  EXPECT_EQ(whole.image[0][0][0][1].item<float>(), 0);
  EXPECT_EQ(whole.image[1][2][1][3].item<float>(), 0);
  EXPECT_EQ(whole.image[1][2][3][3].item<float>(), 106);
  EXPECT_EQ(whole.labels[0][0][0][0].item<float>(), 1);
  EXPECT_EQ(whole.labels[0][1][0][0].item<float>(), 0);
  EXPECT_EQ(whole.labels[0][1][2][1].item<float>(), 5);
}

TEST(RolloutMemory, WhatIsKeptHasNoGradient) {
  RolloutMemory memory = Memory();
  MotionState predicted = Filled({1, 2});
  predicted.image.requires_grad_(true);
  memory.Keep(Turn(2, {{}, {}}), predicted);
  EXPECT_FALSE(memory.Before(Turn(2, {{}, {}})).image.requires_grad());
}

TEST(RolloutMemory, ACheckpointOfOtherRolloutsIsRefused) {
  const std::string path = EmptyFolder("rollout_memory") + "/rollouts.bin";
  RolloutMemory written = Memory();
  written.Keep(Turn(1, {{}, {}}), Filled({7, 8}));
  Checkpoint out("rollouts");
  written.AddTo(&out);
  out.Save(path);
  RolloutMemory same = Memory(), other = Memory(kRollouts + 1);
  Checkpoint in("rollouts"), in_other("rollouts");
  same.AddTo(&in);
  in.Load(path);
  same.Begin();
  EXPECT_TRUE(torch::equal(same.Before(Turn(1, {{}, {}})).labels, Filled({7, 8}).labels));
  other.AddTo(&in_other);
  in_other.Load(path);
  EXPECT_THROW(other.Begin(), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::rollout_memory_test
