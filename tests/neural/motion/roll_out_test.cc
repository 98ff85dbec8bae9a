// SPDX-License-Identifier: Apache-2.0
// Frame-by-frame rendering of the motion-dependent renderer, and the reach of clothes.
#include <gtest/gtest.h>

#include "neural/motion/frame_tensors.h"
#include "neural/motion/motion_frame.h"
#include "neural/motion/motion_model.h"
#include "neural/motion/roll_out.h"
#include "tests/neural/motion/toy_motion.h"

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

}  // namespace
}  // namespace bodyloom::roll_out_test
