// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/learning/early_stopping.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/render/gaussian_avatar/learning/training_example.h"
#include "tests/render/splat/same_bytes.h"

namespace bodyloom::early_stopping_test {
namespace {

constexpr EarlyStoppingOptions kOptions = {
    .every = 10, .smoothed = 1, .min_patience = 40, .min_cooldown = 20, .patience_share = 0.5, .cooldown_share = 0.5};

/// After losses every ten steps.
template <typename LossAt>
EarlyStopping After(int steps, LossAt loss_at, const EarlyStoppingOptions& options = kOptions) {
  EarlyStopping curve;
  for (int step = options.every; step <= steps; step += options.every) {
    curve.Add(loss_at(step), step, step / 1000.0, options);
  }
  return curve;
}

TEST(EarlyStopping, WhatGetsBetterNeverLands) {
  const EarlyStopping curve = After(1000, [](int step) { return 1.0 / step; });
  EXPECT_EQ(curve.cooldown_step, 0);
  EXPECT_EQ(curve.Progress(1000, kOptions), 0);
  EXPECT_EQ(curve.BestStep(kOptions), 1000);
}

TEST(EarlyStopping, LandsTheWaitAfterTheBest) {
  // Best after 50 steps: the least wait counts. After 200: the share.
  const EarlyStopping early = After(500, [](int step) { return std::abs(step - 50); });
  EXPECT_EQ(early.BestStep(kOptions), 50);
  EXPECT_EQ(early.cooldown_step, 90);
  EXPECT_DOUBLE_EQ(early.cooldown_progress, 0.09);
  const EarlyStopping late = After(500, [](int step) { return std::abs(step - 200); });
  EXPECT_EQ(late.cooldown_step, 300);
  // From 0.3 to 1 in 150 steps.
  EXPECT_DOUBLE_EQ(late.Progress(300, kOptions), 0.3);
  EXPECT_DOUBLE_EQ(late.Progress(375, kOptions), 0.65);
  EXPECT_DOUBLE_EQ(late.Progress(450, kOptions), 1);
  EXPECT_DOUBLE_EQ(late.Progress(9999, kOptions), 1);
}

TEST(EarlyStopping, ALuckyJudgementAloneIsNotTheBest) {
  EarlyStoppingOptions options = kOptions;
  const auto noisy = [](int step) { return 1.0 / step - (step == 20 ? 0.06 : 0); };
  EXPECT_GT(After(200, noisy, options).cooldown_step, 0);
  options.smoothed = 5;
  EXPECT_EQ(After(200, noisy, options).cooldown_step, 0);
}

TEST(EarlyStopping, RefusesOptionsOutOfRange) {
  std::string why;
  EXPECT_TRUE(kOptions.IsValid(&why)) << why;
  EarlyStoppingOptions bad;
  bad.smoothed = 0;
  EXPECT_FALSE(bad.IsValid(&why));
  bad = {}, bad.patience_share = std::nan("");
  EXPECT_FALSE(bad.IsValid(&why));
  bad = {}, bad.min_cooldown = 0;
  EXPECT_FALSE(bad.IsValid(&why));
}

AvatarTrainerOptions Watched() {
  AvatarTrainerOptions options;
  options.steps = 4000;
  options.held_out = {.every = 5, .smoothed = 2, .min_patience = 20, .min_cooldown = 15};
  return options;
}

/// The example's last view in colours that no other has: better at first, when the shape is learned, and then worse.
TrainingView MaskError(const TrainingExample& example) {
  TrainingView view = example.views[3];
  for (size_t i = 0; i < view.pixels.size(); ++i) {
    if (i % 4 != 3) view.pixels[i] = static_cast<uint8_t>(255 - view.pixels[i]);
  }
  return view;
}

TEST(EarlyStopping, ATrainingEndsWhereFramesHeldOutGetWorse) {
  const TrainingExample& example = Example();
  const std::vector<TrainingView> held_out = {TrainingView(), MaskError(example)};
  AvatarTrainingState state = example.Start(), parts = state;
  AvatarTrainer trainer(example.model.data().faces, std::span(example.views).first(3), Watched());
  trainer.SetValidationViews(held_out);
  while (!trainer.IsDone(state)) trainer.Step(&state);
  EXPECT_LT(state.step, 1000);
  ASSERT_GT(state.held_out.cooldown_step, 0);
  EXPECT_EQ(state.held_out.losses.size(), static_cast<size_t>(state.step / 5));

  // The result is the avatar of that step.
  ASSERT_TRUE(state.kept.has_value());
  EXPECT_LT(state.kept->step, state.held_out.cooldown_step);
  EXPECT_EQ(state.kept->loss, *std::min_element(state.held_out.losses.begin(), state.held_out.losses.end()));
  AvatarTrainingState then = example.Start();
  AvatarTrainer until_then(example.model.data().faces, std::span(example.views).first(3), Watched());
  while (then.step < state.kept->step) until_then.Step(&then);
  EXPECT_TRUE(SameBytes(state.ResultBody().parameters, then.body.parameters));
  EXPECT_TRUE(SameBytes(then.ResultBody().parameters, then.body.parameters));

  // Left while it lands and gone on with, by another number of threads.
  for (const int64_t until : {state.held_out.cooldown_step - 3, state.held_out.cooldown_step + 4, state.step}) {
    AvatarTrainerOptions options = Watched();
    options.num_threads = until % 2 == 0 ? 2 : 3;
    AvatarTrainer again(example.model.data().faces, std::span(example.views).first(3), options);
    again.SetValidationViews(held_out);
    while (parts.step < until) again.Step(&parts);
    EXPECT_EQ(again.IsDone(parts), until == state.step);
  }
  EXPECT_TRUE(SameBytes(state.body.parameters, parts.body.parameters));
  EXPECT_EQ(state.held_out.losses, parts.held_out.losses);
  EXPECT_TRUE(SameBytes(state.ResultBody().parameters, parts.ResultBody().parameters));

  // Nobody watches, or the frames are learned from: it goes on.
  for (const bool watches : {false, true}) {
    AvatarTrainer other(example.model.data().faces, example.views, Watched());
    if (watches) other.SetValidationViews(std::span(example.views).first(2));
    AvatarTrainingState longer = example.Start();
    while (longer.step < 150) other.Step(&longer);
    EXPECT_FALSE(other.IsDone(longer));
    EXPECT_EQ(longer.held_out.losses.size(), watches ? 30U : 0U);
    EXPECT_EQ(longer.held_out.cooldown_step, 0);
  }
}

TEST(EarlyStopping, TheLastStepIsJudgedToo) {
  const TrainingExample& example = Example();
  AvatarTrainerOptions options = Watched();
  options.steps = 13;
  AvatarTrainer trainer(example.model.data().faces, example.views, options);
  trainer.SetValidationViews(std::span(example.views).first(2));
  AvatarTrainingState state = example.Start();
  while (!trainer.IsDone(state)) trainer.Step(&state);
  EXPECT_EQ(state.held_out.losses.size(), 2U);
  ASSERT_TRUE(state.kept.has_value());
  EXPECT_EQ(state.kept->step, 13) << "frames that are learned from get better";
}

TEST(OtherCloth, IsLearnedFromInTurn) {
  const TrainingExample& example = Example();
  const size_t size = example.views[0].frame.bones.size();
  // The whole body as cloth: the other run has it a metre further away.
  std::vector<TrainingView> views = {example.views[0]};
  std::vector<float> away = views[0].frame.bones;
  for (size_t k = 11; k < size; k += 12) away[k] += 1;
  views[0].other_cloth = {away};
  views[0].time = 0;
  TrainingView far = example.views[0];
  far.frame.bones = away;
  const auto losses = [&](std::span<const TrainingView> of) {
    AvatarTrainerOptions options;
    options.learn_person = false;
    AvatarTrainer trainer(example.model.data().faces, of, options);
    AvatarTrainingState state = example.Start();
    std::vector<double> found;
    found.reserve(4);
    for (int k = 0; k < 4; ++k) found.push_back(trainer.Step(&state).loss);
    return found;
  };
  const std::vector<TrainingView> near_alone = {example.views[0]}, far_alone = {far};
  const std::vector<double> both = losses(views), near = losses(near_alone), farther = losses(far_alone);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(both[k], k % 2 == 0 ? near[k] : farther[k]) << k;
  EXPECT_NE(near[0], farther[0]);
}

}  // namespace
}  // namespace bodyloom::early_stopping_test
