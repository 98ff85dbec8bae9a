// SPDX-License-Identifier: Apache-2.0
// Progress reports of a training to its caller.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "pipelines/neural/training_session.h"

namespace bodyloom::follow_training_test {
namespace {

TEST(FollowTraining, TellsTheFiguresAndStopsWhereTheCallerDoes) {
  std::string work, stage;
  double fraction = 0;
  bool goes_on = true;
  PipelineCallbacks callbacks;
  callbacks.begin = [&](const std::string& name) { work = name; };
  callbacks.progress = [&](const std::string& name, double done) {
    stage = name, fraction = done;
    return goes_on;
  };
  TrainingRun run;
  FollowTraining(400, callbacks, &run);
  EXPECT_EQ(work, "training 400 steps");
  const TrainingProgress progress = {100, 400, {{"loss", 0.12345}, {"validation", 21.3456, " dB"}}, 1};
  EXPECT_TRUE(run.progress(progress));
  EXPECT_EQ(stage, "loss 0.123, validation 21.3 dB");
  EXPECT_EQ(fraction, 0.25);
  goes_on = false;
  EXPECT_FALSE(run.progress(progress));
  EXPECT_EQ(progress.At("validation"), 21.3456);
  EXPECT_THROW((void)progress.At("image"), std::invalid_argument);
}

TEST(FollowTraining, GoesOnWithoutACaller) {
  const PipelineCallbacks nobody;
  TrainingRun run;
  FollowTraining(2, nobody, &run);
  EXPECT_TRUE(run.progress({1, 2, {}, 0}));
}

}  // namespace
}  // namespace bodyloom::follow_training_test
