// SPDX-License-Identifier: Apache-2.0
// Frame-by-frame rendering of the motion-dependent renderer, and the reach of clothes.
#include <gtest/gtest.h>

#include "neural/base/image_tensor.h"
#include "neural/motion/frame_tensors.h"
#include "neural/motion/motion_frame.h"
#include "neural/motion/motion_model.h"
#include "neural/motion/roll_out.h"
#include "tests/neural/motion/toy_motion.h"
#include "tests/support/test_files.h"

namespace bodyloom::roll_out_test {
namespace {

TEST(RollOut, KeepsWhatDoesNotChangeAndSaysTheSame) {
  torch::manual_seed(5);
  const MotionConfig config = Toy();
  MotionModel model(config);
  RollOut roll(model, 3);
  MotionState past = model->InitialState(1, 32, 32);
  const torch::NoGradGuard no_grad;
  for (const int t : {2, 2, 2, 3, 4, 4}) {
    MotionFrame frame;
    ToyFrame(t, false, &frame);
    frame.before_x = 0;
    const MotionStepResult kept = roll.Next(frame);
    const MotionInput input = InputOf(std::span(&frame, 1), config);
    const int passes = past.image.abs().max().item<float>() == 0 ? 4 : 1;
    for (int i = 0; i < passes; ++i) past = model(input, past).state;
    EXPECT_TRUE(torch::equal(kept.state.image, past.image)) << "frame " << t;
  }
  EXPECT_EQ(roll.descriptors_kept(), 3);
  EXPECT_EQ(roll.projections_kept(), 3);
}

TEST(RollOut, NothingIsBeyondReach) {
  torch::manual_seed(6);
  const MotionConfig config = Toy();
  MotionModel model(config);  // untrained: sees the person everywhere
  RollOut whole_window(model, 2), near(model, 2, {3});
  MotionFrame frame;
  ToyFrame(1, false, &frame);
  const MotionStepResult all = whole_window.Next(frame), kept = near.Next(frame);
  int beyond = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      // The body is [7, 23) × [8, 24).
      if (x >= 4 && x < 26 && y >= 5 && y < 27) continue;
      beyond += all.foreground[0][0][y][x].item<float>() > 0.01F;
      EXPECT_EQ(kept.foreground[0][0][y][x].item<float>(), 0);
      EXPECT_EQ(kept.state.labels[0][0][y][x].item<float>(), 1);
      EXPECT_EQ(kept.state.image[0][1][y][x].item<float>(), 0);
    }
  }
  EXPECT_GT(beyond, 100);
  EXPECT_GT(kept.foreground[0][0][5][4].item<float>(), 0);
}

TEST(ClothesReach, IsTheLongerOfBothDistances) {
  MotionFrame frame;
  ToyFrame(0, true, &frame);
  EXPECT_EQ(ClothesReach(std::span(&frame, 1)), 0);  // labels are where the body is: [6, 22) × [8, 24)
  frame.labels[10 * 32 + 27] = 1;                    // 6 to the right
  EXPECT_EQ(ClothesReach(std::span(&frame, 1), 0), 6);
  frame.labels[31 * 32 + 24] = 1;  // 3 to the right, 8 below
  EXPECT_EQ(ClothesReach(std::span(&frame, 1), 0), 8);
  EXPECT_EQ(ClothesReach(std::span(&frame, 1), 0.1), 0);  // two of 258 pixels may stay out
  frame.labels.clear();
  EXPECT_EQ(ClothesReach(std::span(&frame, 1)), 0);
}

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

}  // namespace bodyloom::roll_out_test
