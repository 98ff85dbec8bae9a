// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <csignal>

#include <chrono>
#include <sstream>
#include <thread>

#include "apps/progress.h"

namespace bodyloom::progress_test {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Progress, WritesOneLineAStageWhenNotATerminal) {
  std::ostringstream out;
  {
    Progress progress("tracking", Progress::Style::kLines, out);
    for (int i = 0; i <= 100; ++i) {
      progress.Update(i < 50 ? "initialise" : "fit", 0.01 * i);
    }
  }
  EXPECT_EQ(out.str(), "tracking 0 % initialise\ntracking 50 % fit, 0:00 left\n");
}

TEST(Progress, TheTimeLeftOfARunThatGoesOnIsItsOwn) {
  std::ostringstream out;
  Progress progress("training", Progress::Style::kLines, out);
  progress.Update("begin", 0.5);  // what an earlier run did
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  progress.Update("train", 0.55);  // 45 % are left at 5 % in 0.3 s: 2.7 s or more
  EXPECT_THAT(out.str(), HasSubstr("55 % train, 0:0"));
  EXPECT_THAT(out.str(), Not(HasSubstr("0:00 left")));
}

TEST(Progress, DrawsABarThatIsWipedAtTheEnd) {
  std::ostringstream out;
  {
    Progress progress("tracking", Progress::Style::kBar, out);
    progress.Update("fit", 0.5);
    EXPECT_THAT(out.str(), HasSubstr("\rtracking [############............] 50 % fit"));
  }
  EXPECT_THAT(out.str(), EndsWith(" \r"));
  EXPECT_THAT(out.str(), Not(HasSubstr("\n")));
}

TEST(Progress, ABarThatWasWipedIsDrawnAgain) {
  std::ostringstream out;
  Progress progress("tracking", Progress::Style::kBar, out);
  progress.Update("fit", 0.25);
  progress.Wipe();
  EXPECT_THAT(out.str(), EndsWith(" \r"));
  const size_t wiped = out.str().size();
  progress.Wipe();
  EXPECT_EQ(out.str().size(), wiped) << "nothing is left to wipe";
  progress.Update("write", 0.75);
  EXPECT_THAT(out.str().substr(wiped), HasSubstr("75 % write"));
}

TEST(Progress, NeverGoesBackAndStaysWithinBounds) {
  std::ostringstream out;
  Progress progress("x", Progress::Style::kLines, out);
  progress.Update("a", 0.6);
  progress.Update("b", 0.2);
  progress.Update("c", 7);
  EXPECT_THAT(out.str(), HasSubstr("x 60 % b"));
  EXPECT_THAT(out.str(), HasSubstr("x 100 % c"));
}

TEST(Progress, SilentWritesNothing) {
  std::ostringstream out;
  Progress("x", Progress::Style::kSilent, out).Update("a", 0.5);
  EXPECT_EQ(out.str(), "");
}

TEST(CommandCallbacks, MessagesAreLines) {
  std::ostringstream out;
  const PipelineCallbacks callbacks = CommandCallbacks(true, out);
  callbacks.Begin("tracking");
  callbacks.Update("fit", 0.5);
  callbacks.Message("one");
  callbacks.Message("");
  EXPECT_EQ(out.str(), "one\n\n");
}

TEST(CommandCallbacks, WorkWithoutANameIsNotShown) {
  ::testing::internal::CaptureStderr();
  {
    const PipelineCallbacks callbacks = CommandCallbacks();
    callbacks.Update("read", 0);
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(CommandCallbacks, EveryWorkBeginsANewLine) {
  ::testing::internal::CaptureStderr();
  {
    const PipelineCallbacks callbacks = CommandCallbacks();
    callbacks.Begin("rendering");
    callbacks.Update("clip", 0.5);
    callbacks.Begin("tracking");
    callbacks.Update("fit", 0);
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "rendering 50 % clip\ntracking 0 % fit\n")
      << "of one report nobody knows how long it took";
}

TEST(CommandCallbacks, AnInterruptCancels) {
  EXPECT_EXIT(
      {
        InstallSignalHandlers();
        const PipelineCallbacks callbacks = CommandCallbacks(true);
        const bool before = callbacks.ReportProgress("fit", 0);
        std::raise(SIGINT);
        std::exit(before && !callbacks.ReportProgress("fit", 0.5) ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

}  // namespace

}  // namespace bodyloom::progress_test
