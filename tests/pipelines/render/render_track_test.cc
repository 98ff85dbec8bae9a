// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/render/render_track.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <utility>

namespace bodyloom {
namespace {

TEST(FrameRange, ReadsWhatUsersWrite) {
  EXPECT_EQ(FrameRange("", 10, "t"), std::make_pair(0, 10));
  EXPECT_EQ(FrameRange("3", 10, "t"), std::make_pair(3, 4));
  EXPECT_EQ(FrameRange("3:", 10, "t"), std::make_pair(3, 10));
  EXPECT_EQ(FrameRange(":7", 10, "t"), std::make_pair(0, 7));
  EXPECT_EQ(FrameRange("3:7", 10, "t"), std::make_pair(3, 7));
  EXPECT_THROW(FrameRange("10", 10, "t"), std::runtime_error);
  EXPECT_THROW(FrameRange("9:11", 10, "t"), std::runtime_error);
  EXPECT_THROW(FrameRange("7:3", 10, "t"), RequestError);
}

}  // namespace
}  // namespace bodyloom
