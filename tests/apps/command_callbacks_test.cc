// SPDX-License-Identifier: Apache-2.0
#include "apps/progress.h"

#include <gtest/gtest.h>

#include <csignal>
#include <sstream>

namespace bodyloom::command_callbacks_test {
namespace {

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
}  // namespace bodyloom::command_callbacks_test
