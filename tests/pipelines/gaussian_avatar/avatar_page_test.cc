// SPDX-License-Identifier: Apache-2.0
// Subsampling of long clips; the drawn page is tested by tests/page/avatar_test.py.
#include "pipelines/gaussian_avatar/avatar_page.h"

#include <gtest/gtest.h>

namespace bodyloom::avatar_page_test {
namespace {

TEST(AvatarPage, ShowsAsManyFramesAsBonesFitIn) {
  EXPECT_EQ(AvatarPage::FrameStep(1, 24), 1);
  EXPECT_EQ(AvatarPage::FrameStep(13000, 24), 1);
  constexpr double kBytesOfBone = 48, kMaximum = 16e6;
  for (const int frames : {100, 1500, 20000, 200000}) {
    for (const int bones : {24, 245, 1000}) {
      const int step = AvatarPage::FrameStep(frames, bones);
      EXPECT_LE(frames * bones * kBytesOfBone / step, kMaximum) << frames << ' ' << bones;
      if (step > 1) {
        EXPECT_GT(frames * bones * kBytesOfBone / (step - 1), kMaximum) << "thinned more than it must be";
      }
    }
  }
}

}  // namespace
}  // namespace bodyloom::avatar_page_test
