// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bodyloom/render/avatar/learning/avatar_trainer.h"
#include "tests/render/avatar/learning/lesson.h"
#include "tests/render/splat/same_bytes.h"

namespace bodyloom {
namespace {

MotionNetworkOptions Small() { return {.maps = 1, .embedding = 2, .width = 16, .outputs = kMotionChannels}; }

/// The lesson's poses, each seen slow and fast; fast ones are darker. The one map says which.
struct SpeedLesson {
  const Lesson& lesson = TheLesson();
  std::vector<TrainingView> views;
  SpeedLesson() {
    for (const TrainingView& view : lesson.views) {
      for (const bool fast : {false, true}) {
        views.push_back(view);
        views.back().time = static_cast<int>(views.size()) - 1;
        for (size_t i = 0; fast && i < view.pixels.size(); ++i) {
          if (i % 4 != 3) views.back().pixels[i] = static_cast<uint8_t>(0.7 * view.pixels[i]);
        }
      }
    }
  }
  static void Maps(int time, std::span<float> maps) {
    std::fill(maps.begin(), maps.end(), time % 2 == 0 ? -0.5F : 0.5F);
  }
};

const SpeedLesson& Speeds() {
  static const SpeedLesson speeds;
  return speeds;
}

AvatarTrainerOptions Steps(int64_t steps, int threads = 1) {
  AvatarTrainerOptions options;
  options.steps = steps;
  options.relocate_every = 10;
  options.num_threads = threads;
  return options;
}

/// Mean loss of the last 16 steps.
double LossAtTheEnd(bool with_motion) {
  const SpeedLesson& speeds = Speeds();
  AvatarMotion motion(speeds.lesson.model, Small());
  AvatarTrainingState state = speeds.lesson.Start();
  if (with_motion) state.BeginMotion(motion.Initial(1));
  AvatarTrainer trainer(speeds.lesson.model.data().faces, speeds.views, Steps(160), nullptr,
                        with_motion ? MotionLesson{&motion, SpeedLesson::Maps} : MotionLesson{});
  double sum = 0;
  while (!trainer.IsDone(state)) {
    const double loss = trainer.Step(&state).loss;
    if (state.step > 144) sum += loss / 16;
  }
  return sum;
}

TEST(MotionLearning, TellsFastFromSlow) {
  const double without = LossAtTheEnd(false), with = LossAtTheEnd(true);
  EXPECT_LT(with, 0.75 * without) << without;
}

TEST(MotionLearning, SameBytesForAnyThreadsAndInstructionSet) {
  const SpeedLesson& speeds = Speeds();
  ExpectSameBytesEverywhere([&](int threads, FloatColumns* table) {
    AvatarMotion motion(speeds.lesson.model, Small());
    AvatarTrainingState state = speeds.lesson.Start();
    state.BeginMotion(motion.Initial(1));
    AvatarTrainerOptions options = Steps(12, threads);
    options.dead_opacity = 0.88F;  // half of them move, and stand elsewhere on the atlas then
    AvatarTrainer trainer(speeds.lesson.model.data().faces, speeds.views, options, nullptr,
                          {&motion, SpeedLesson::Maps});
    int relocated = 0;
    while (!trainer.IsDone(state)) relocated += trainer.Step(&state).relocated;
    EXPECT_GT(relocated, 0);
    *table = state.motion;
    for (int i = 0; i < state.body.size(); ++i) (*table)(i, 0) += state.body.parameters(i, GaussianBody::kAlbedo);
  });
}

TEST(MotionLearning, AKeptStateGoesOnAsIfNeverLeft) {
  const SpeedLesson& speeds = Speeds();
  const auto run = [&](int64_t until, AvatarTrainingState* state) {
    AvatarMotion motion(speeds.lesson.model, Small());
    AvatarTrainer trainer(speeds.lesson.model.data().faces, speeds.views, Steps(24), nullptr,
                          {&motion, SpeedLesson::Maps});
    while (state->step < until) trainer.Step(state);
  };
  AvatarMotion motion(speeds.lesson.model, Small());
  AvatarTrainingState whole = speeds.lesson.Start();
  whole.BeginMotion(motion.Initial(1));
  AvatarTrainingState parts = whole;
  run(24, &whole);
  run(13, &parts);
  const AvatarTrainingState kept = parts;
  parts = kept;
  run(24, &parts);
  EXPECT_TRUE(SameBytes(whole.motion, parts.motion));
  EXPECT_TRUE(SameBytes(whole.motion_adam.second, parts.motion_adam.second));
  EXPECT_TRUE(SameBytes(whole.body.parameters, parts.body.parameters));
}

TEST(MotionLearning, APersonWithoutANetworkIsNotTaughtByOne) {
  const SpeedLesson& speeds = Speeds();
  AvatarMotion motion(speeds.lesson.model, Small());
  AvatarTrainingState state = speeds.lesson.Start();
  AvatarTrainer trainer(speeds.lesson.model.data().faces, speeds.views, Steps(2), nullptr,
                        {&motion, SpeedLesson::Maps});
  EXPECT_THROW(trainer.Step(&state), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom
