// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/person_box.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "neural/motion/frame_tensors.h"
#include "neural/motion/motion_renderer.h"
#include "neural/motion/roll_out.h"
#include "neural/networks/aligned_box.h"
#include "neural/training/checkpoint.h"
#include "tests/neural/motion/toy_motion.h"

namespace bodyloom::person_box_test {
namespace {

using torch::Tensor;

constexpr int kWidth = 96, kHeight = 64, kMultiple = 4, kReach = 3;

std::array<int, 4> Sides(const PixelBox& box) { return {box.x_begin, box.y_begin, box.x_end, box.y_end}; }
void ExpectBox(const PixelBox& box, const PixelBox& expected) { EXPECT_EQ(Sides(box), Sides(expected)); }

MotionFrame Frame(int t, bool with_truth = true) {
  MotionFrame frame;
  ToyFrameIn(kWidth, kHeight, t, with_truth, &frame);
  return frame;
}

MotionConfig AroundBody() {
  MotionConfig config = Toy();
  config.around_body = true;
  return config;
}

TEST(AlignedBox, BeginsAndEndsAtCells) {
  const PixelBox window = {0, 0, 96, 64};
  ExpectBox(AlignedBox({5, 9, 21, 48}, window, 8, 8, 8), {0, 8, 24, 48});
  ExpectBox(AlignedBox({-20, 60, 12, 90}, window, 8, 8, 8), {0, 56, 16, 64});    // what the window has of it
  ExpectBox(AlignedBox({40, 24, 41, 25}, window, 8, 32, 24), {24, 16, 56, 40});  // widened by turns
  ExpectBox(AlignedBox({0, 60, 3, 64}, window, 8, 32, 24), {0, 40, 32, 64});     // where there is room
  ExpectBox(AlignedBox({40, 24, 41, 25}, window, 8, 1000, 1000), window);
  ExpectBox(AlignedBox({}, window, 8, 32, 32), {32, 16, 64, 48});
  EXPECT_EQ(MinBoxSide(8), 32);
  EXPECT_EQ(MinBoxSide(32), 64);
}

TEST(PersonBox, HoldsTheBodyAndItsReachAndIsOneSizeForABatch) {
  std::vector<MotionFrame> frames = {Frame(0), Frame(3)};
  // [6, 22) × [8, 24) and 3 to the right, 3 around; at least 32 a side.
  for (const PixelBox& box : PersonBoxes(frames, kReach, kMultiple)) ExpectBox(box, {0, 0, 32, 32});
  // One that is wider: the other's box is as wide.
  for (int x = 0; x < 60; ++x) frames[1].body[20 * kWidth + x] = 1;
  const std::vector<PixelBox> boxes = PersonBoxes(frames, kReach, kMultiple);
  ExpectBox(boxes[1], {0, 0, 64, 32});
  ExpectBox(boxes[0], {0, 0, 64, 32});
  for (const PixelBox& box : PersonBoxes(frames, 0, kMultiple)) ExpectBox(box, {0, 0, kWidth, kHeight});
  for (const PixelBox& box : PersonBoxes(frames, 1000, kMultiple)) ExpectBox(box, {0, 0, kWidth, kHeight});
  frames[0].body.assign(frames[0].body.size(), 0);
  EXPECT_EQ(PersonBoxes(std::span(frames).first(1), kReach, kMultiple)[0].area(), 32U * 32);
}

TEST(PersonBox, RefusesFramesThatAreNotWhole) {
  std::vector<MotionFrame> frames = {Frame(0), Frame(1)};
  frames[1].body.pop_back();
  EXPECT_THROW(PersonBoxes(frames, kReach, kMultiple), std::invalid_argument);
  ToyFrameIn(kWidth, kHeight + 4, 1, true, &frames[1]);
  for (const int reach : {0, kReach}) {
    EXPECT_THROW(PersonBoxes(frames, reach, kMultiple), std::invalid_argument) << reach;
  }
  frames[0].image.pop_back();
  EXPECT_THROW(Within(frames[0], {0, 0, 32, 32}), std::invalid_argument);
}

TEST(PersonBox, CutsFramesAndTensorsAlikeAndPutsThemBack) {
  const MotionConfig config = Toy();
  const PixelBox box = {4, 8, 40, 32};
  const MotionFrame frame = Frame(2), cut = Within(frame, box);
  EXPECT_EQ(cut.motion, frame.motion);
  const MotionTruth whole = TruthOf(std::span(&frame, 1), config), seen = TruthOf(std::span(&cut, 1), config);
  const MotionInput input = InputOf(std::span(&frame, 1), config), part = InputOf(std::span(&cut, 1), config);
  for (const auto& [large, small] :
       {std::pair(whole.image, seen.image), std::pair(whole.labels, seen.labels),
        std::pair(whole.normals, seen.normals), std::pair(input.uv, part.uv), std::pair(input.body, part.body)}) {
    EXPECT_TRUE(torch::equal(Within(large, box), small));
  }
  // All of the person is in the box: put back, it is the frame as it was.
  const MotionState back = OnWindow(seen.State(config), box, kHeight, kWidth);
  EXPECT_TRUE(torch::equal(back.image, whole.image));
  EXPECT_TRUE(torch::equal(back.normals, whole.normals));
  EXPECT_TRUE(torch::equal(back.labels, whole.labels));  // class 0 around the box
}

TEST(PersonBox, ARollOutInItIsThatOfTheCutFrames) {
  torch::manual_seed(5);
  MotionModel model(AroundBody());
  RollOut roll(model, 2, {kReach, /*whole_window=*/true});
  MotionModel same(Toy());
  const torch::NoGradGuard no_grad;
  for (size_t i = 0; i < same->parameters().size(); ++i) same->parameters()[i].copy_(model->parameters()[i]);
  RollOut of_cut(same, 2);
  const PixelBox box = {0, 0, 32, 32};
  for (const int t : {0, 1, 1, 2}) {
    const MotionFrame frame = Frame(t, false), cut = Within(frame, box);
    const MotionStepResult shown = roll.Next(frame), expected = of_cut.Next(cut);
    EXPECT_TRUE(torch::equal(Within(shown.state.image, box), expected.state.image)) << t;
    EXPECT_TRUE(torch::equal(Within(shown.state.labels, box), expected.state.labels)) << t;
    ASSERT_EQ(shown.state.image.size(3), kWidth);
    EXPECT_EQ(shown.state.image.slice(3, 32).abs().max().item<float>(), 0);
    EXPECT_EQ(shown.state.labels.slice(1, 0, 1).slice(3, 32).min().item<float>(), 1);
    EXPECT_EQ(shown.foreground.slice(2, 32).max().item<float>(), 0);
  }
  EXPECT_EQ(roll.projections_kept(), 1);
  EXPECT_THROW(RollOut(model, 2), std::invalid_argument);
}

TEST(PersonBox, ATrainingWhoseBoxesAreWholeWindowsIsThatOfWholeWindows) {
  const auto source = [](int t, bool with_truth, MotionFrame* frame) {
    ToyFrameIn(kWidth, kHeight, t, with_truth, frame);
  };
  const auto train = [&](const char* name, bool around_body, int reach) {
    TrainMotionOptions options = ToyOptions(name);
    options.config.around_body = around_body;
    options.reach = reach;
    EXPECT_EQ(TrainMotion(source, options).status, TrainingStatus::kFinished);
    MotionRenderer renderer(CheckpointPath(options.run_dir), options.config,
                            {.warmup_iterations = 0, .reach = reach, .whole_window = true, .num_threads = 1});
    return renderer.Next(Frame(1)).image;
  };
  const std::vector<float> whole = train("box_off", false, 0);
  EXPECT_EQ(train("box_whole", true, 1000), whole);
  EXPECT_NE(train("box", true, kReach), whole);
}

TEST(PersonBox, ATrainingInBoxesLearnsAndIsResumedExactly) {
  TrainMotionOptions options = ToyOptions("box_learns");
  const auto source = [](int t, bool with_truth, MotionFrame* frame) {
    ToyFrameIn(kWidth, kHeight, t, with_truth, frame);
  };
  options.config.around_body = true;
  options.reach = kReach;
  options.train = options.validation = {{0, 4}};
  options.steps = 160;
  options.learning_rate = 5e-3;
  options.gan_weight = 0;
  options.checkpoint_every = options.validate_every = 80;
  const TrainMotionSummary summary = TrainMotion(source, options);
  ASSERT_EQ(summary.status, TrainingStatus::kFinished) << summary.message;
  EXPECT_LT(summary.scores.image_l1, 0.1);
  EXPECT_GT(summary.scores.label_iou, 0.7);
  TrainMotionOptions parts = options;
  parts.run_dir = EmptyFolder("box_parts");
  parts.progress = [](const TrainingProgress& progress) { return progress.step < 80; };
  EXPECT_EQ(TrainMotion(source, parts).status, TrainingStatus::kStopped);
  parts.progress = nullptr;
  parts.resume = true;
  ASSERT_EQ(TrainMotion(source, parts).status, TrainingStatus::kFinished);
  EXPECT_EQ(FileBytes(CheckpointPath(parts.run_dir)), FileBytes(CheckpointPath(options.run_dir)));
  // Networks that look around the body are not those of whole windows.
  MotionConfig other = options.config;
  other.around_body = false;
  EXPECT_THROW(MotionRenderer(CheckpointPath(options.run_dir), other), std::runtime_error);
  options.reach = 0;
  EXPECT_THROW(TrainMotion(source, options), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::person_box_test
