// SPDX-License-Identifier: Apache-2.0
#include "geometry/base/callbacks.h"

#include <gtest/gtest.h>

#include <string>

namespace bodyloom::callbacks_test {
namespace {

TEST(PipelineCallbacks, WithoutAnyAJobRunsThrough) {
  const PipelineCallbacks none;
  EXPECT_NO_THROW(none.Begin("work"));
  EXPECT_TRUE(none.ReportProgress("stage", 0.5));
  EXPECT_NO_THROW(none.Update("stage", 0.5));
  EXPECT_NO_THROW(none.Message("line"));
}

TEST(PipelineCallbacks, FalseCancels) {
  PipelineCallbacks callbacks;
  double last = 0;
  callbacks.progress = [&](const std::string& stage, double fraction) {
    EXPECT_EQ(stage, "fit");
    last = fraction;
    return fraction < 0.5;
  };
  EXPECT_NO_THROW(callbacks.Update("fit", 0.25));
  EXPECT_FALSE(callbacks.ReportProgress("fit", 0.5));
  EXPECT_THROW(callbacks.Update("fit", 0.75), Cancelled);
  EXPECT_EQ(last, 0.75);
}

TEST(PipelineCallbacks, WorkAndLinesArrive) {
  PipelineCallbacks callbacks;
  std::string heard;
  callbacks.begin = [&](const std::string& work) { heard += "begin " + work + "; "; };
  callbacks.message = [&](const std::string& line) { heard += line; };
  callbacks.Begin("tracking 3 frames");
  callbacks.Message("one file left out");
  EXPECT_EQ(heard, "begin tracking 3 frames; one file left out");
}

}  // namespace
}  // namespace bodyloom::callbacks_test
