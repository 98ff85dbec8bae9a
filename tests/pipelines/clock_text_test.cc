// SPDX-License-Identifier: Apache-2.0
#include "pipelines/report_text.h"

#include <gtest/gtest.h>

namespace bodyloom::clock_text_test {
namespace {

TEST(ClockText, MinutesAndHours) {
  EXPECT_EQ(ClockText(0), "0:00");
  EXPECT_EQ(ClockText(7.4), "0:07");
  EXPECT_EQ(ClockText(754), "12:34");
  EXPECT_EQ(ClockText(3723), "1:02:03");
  EXPECT_EQ(ClockText(-3), "0:00");
}

}  // namespace
}  // namespace bodyloom::clock_text_test
