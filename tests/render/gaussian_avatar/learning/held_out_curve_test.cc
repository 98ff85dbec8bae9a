// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/learning/held_out_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/render/gaussian_avatar/learning/lesson.h"
#include "tests/render/splat/same_bytes.h"

namespace bodyloom::held_out_curve_test {
namespace {

constexpr HeldOutOptions kOptions = {
    .every = 10, .smoothed = 1, .least_wait = 40, .least_landing = 20, .wait_share = 0.5, .landing_share = 0.5};

/// After losses every ten steps.
template <typename LossAt>
HeldOutCurve After(int steps, LossAt loss_at, const HeldOutOptions& options = kOptions) {
  HeldOutCurve curve;
  for (int step = options.every; step <= steps; step += options.every) {
    curve.Add(loss_at(step), step, step / 1000.0, options);
  }
  return curve;
}

TEST(HeldOutCurve, WhatGetsBetterNeverLands) {
  const HeldOutCurve curve = After(1000, [](int step) { return 1.0 / step; });
  EXPECT_EQ(curve.landing_step, 0);
  EXPECT_EQ(curve.Progress(1000, kOptions), 0);
  EXPECT_EQ(curve.BestStep(kOptions), 1000);
}

TEST(HeldOutCurve, LandsTheWaitAfterTheBest) {
  // Best after 50 steps: the least wait counts. After 200: the share.
  const HeldOutCurve early = After(500, [](int step) { return std::abs(step - 50); });
  EXPECT_EQ(early.BestStep(kOptions), 50);
  EXPECT_EQ(early.landing_step, 90);
  EXPECT_DOUBLE_EQ(early.landing_progress, 0.09);
  const HeldOutCurve late = After(500, [](int step) { return std::abs(step - 200); });
  EXPECT_EQ(late.landing_step, 300);
  // From 0.3 to 1 in 150 steps.
  EXPECT_DOUBLE_EQ(late.Progress(300, kOptions), 0.3);
  EXPECT_DOUBLE_EQ(late.Progress(375, kOptions), 0.65);
  EXPECT_DOUBLE_EQ(late.Progress(450, kOptions), 1);
  EXPECT_DOUBLE_EQ(late.Progress(9999, kOptions), 1);
}

TEST(HeldOutCurve, ALuckyJudgementAloneIsNotTheBest) {
  HeldOutOptions options = kOptions;
  const auto noisy = [](int step) { return 1.0 / step - (step == 20 ? 0.06 : 0); };
  EXPECT_GT(After(200, noisy, options).landing_step, 0);
  options.smoothed = 5;
  EXPECT_EQ(After(200, noisy, options).landing_step, 0);
}

TEST(HeldOutCurve, RefusesOptionsOutOfRange) {
  std::string why;
  EXPECT_TRUE(kOptions.IsValid(&why)) << why;
  HeldOutOptions bad;
  bad.smoothed = 0;
  EXPECT_FALSE(bad.IsValid(&why));
  bad = {}, bad.wait_share = std::nan("");
  EXPECT_FALSE(bad.IsValid(&why));
  bad = {}, bad.least_landing = 0;
  EXPECT_FALSE(bad.IsValid(&why));
}

AvatarTrainerOptions Watched() {
  AvatarTrainerOptions options;
  options.steps = 4000;
  options.held_out = {.every = 5, .smoothed = 2, .least_wait = 20, .least_landing = 15};
  return options;
}

/// The lesson's last view in colours that no other has: better at first, when the shape is learned, and then worse.
TrainingView Unlike(const Lesson& lesson) {
  TrainingView view = lesson.views[3];
  for (size_t i = 0; i < view.pixels.size(); ++i) {
    if (i % 4 != 3) view.pixels[i] = static_cast<uint8_t>(255 - view.pixels[i]);
  }
  return view;
}

TEST(HeldOutCurve, ATrainingEndsWhereFramesHeldOutGetWorse) {
  const Lesson& lesson = TheLesson();
  const std::vector<TrainingView> held_out = {TrainingView(), Unlike(lesson)};
  AvatarTrainingState state = lesson.Start(), parts = state;
  AvatarTrainer trainer(lesson.model.data().faces, std::span(lesson.views).first(3), Watched());
  trainer.Watch(held_out);
  while (!trainer.IsDone(state)) trainer.Step(&state);
  EXPECT_LT(state.step, 1000);
  ASSERT_GT(state.held_out.landing_step, 0);
  EXPECT_EQ(state.held_out.losses.size(), static_cast<size_t>(state.step / 5));

  // What it leaves is the person of then.
  ASSERT_TRUE(state.kept.has_value());
  EXPECT_LT(state.kept->step, state.held_out.landing_step);
  EXPECT_EQ(state.kept->loss, *std::min_element(state.held_out.losses.begin(), state.held_out.losses.end()));
  AvatarTrainingState then = lesson.Start();
  AvatarTrainer until_then(lesson.model.data().faces, std::span(lesson.views).first(3), Watched());
  while (then.step < state.kept->step) until_then.Step(&then);
  EXPECT_TRUE(SameBytes(state.ResultBody().parameters, then.body.parameters));
  EXPECT_TRUE(SameBytes(then.ResultBody().parameters, then.body.parameters));

  // Left while it lands and gone on with, by another number of threads.
  for (const int64_t until : {state.held_out.landing_step - 3, state.held_out.landing_step + 4, state.step}) {
    AvatarTrainerOptions options = Watched();
    options.num_threads = until % 2 == 0 ? 2 : 3;
    AvatarTrainer again(lesson.model.data().faces, std::span(lesson.views).first(3), options);
    again.Watch(held_out);
    while (parts.step < until) again.Step(&parts);
    EXPECT_EQ(again.IsDone(parts), until == state.step);
  }
  EXPECT_TRUE(SameBytes(state.body.parameters, parts.body.parameters));
  EXPECT_EQ(state.held_out.losses, parts.held_out.losses);
  EXPECT_TRUE(SameBytes(state.ResultBody().parameters, parts.ResultBody().parameters));

  // Nobody watches, or the frames are learned from: it goes on.
  for (const bool watches : {false, true}) {
    AvatarTrainer other(lesson.model.data().faces, lesson.views, Watched());
    if (watches) other.Watch(std::span(lesson.views).first(2));
    AvatarTrainingState longer = lesson.Start();
    while (longer.step < 150) other.Step(&longer);
    EXPECT_FALSE(other.IsDone(longer));
    EXPECT_EQ(longer.held_out.losses.size(), watches ? 30U : 0U);
    EXPECT_EQ(longer.held_out.landing_step, 0);
  }
}

TEST(HeldOutCurve, TheLastStepIsJudgedToo) {
  const Lesson& lesson = TheLesson();
  AvatarTrainerOptions options = Watched();
  options.steps = 13;
  AvatarTrainer trainer(lesson.model.data().faces, lesson.views, options);
  trainer.Watch(std::span(lesson.views).first(2));
  AvatarTrainingState state = lesson.Start();
  while (!trainer.IsDone(state)) trainer.Step(&state);
  EXPECT_EQ(state.held_out.losses.size(), 2U);
  ASSERT_TRUE(state.kept.has_value());
  EXPECT_EQ(state.kept->step, 13) << "frames that are learned from get better";
}

TEST(OtherCloth, IsLearnedFromInTurn) {
  const Lesson& lesson = TheLesson();
  const size_t size = lesson.views[0].frame.bones.size();
  // The whole body as cloth: the other run has it a metre further away.
  std::vector<TrainingView> views = {lesson.views[0]};
  std::vector<float> away = views[0].frame.bones;
  for (size_t k = 11; k < size; k += 12) away[k] += 1;
  views[0].other_cloth = {away};
  views[0].time = 0;
  TrainingView far = lesson.views[0];
  far.frame.bones = away;
  const auto losses = [&](std::span<const TrainingView> of) {
    AvatarTrainerOptions options;
    options.learn_person = false;
    AvatarTrainer trainer(lesson.model.data().faces, of, options);
    AvatarTrainingState state = lesson.Start();
    std::vector<double> found;
    found.reserve(4);
    for (int k = 0; k < 4; ++k) found.push_back(trainer.Step(&state).loss);
    return found;
  };
  const std::vector<TrainingView> near_alone = {lesson.views[0]}, far_alone = {far};
  const std::vector<double> both = losses(views), near = losses(near_alone), farther = losses(far_alone);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(both[k], k % 2 == 0 ? near[k] : farther[k]) << k;
  EXPECT_NE(near[0], farther[0]);
}

}  // namespace
}  // namespace bodyloom::held_out_curve_test
