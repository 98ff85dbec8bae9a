// SPDX-License-Identifier: Apache-2.0
/// Skipped where the recordings or the networks (./dev models) are missing.
#include "tracking/detection/pose_detector.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "data_tools/video/video_reader.h"
#include "tests/support/paths.h"
#include "tests/tracking/detection/models_there.h"
#include "tracking/detection/people_detector.h"

namespace bodyloom::pose_detector_test {
namespace {

TEST(PoseDetector, WithoutTheMaskTheRestHasTheSameBits) {
  const std::string video = SharedDir() + "/data/vid2densepose/input_video.mp4";
  if (!std::filesystem::exists(video)) GTEST_SKIP() << video << " is not there";
  if (!HandModelsAreThere()) GTEST_SKIP() << "no networks; ./dev models fetches them";
  VideoReader reader(video);
  std::vector<Image> frames(2);
  for (Image& frame : frames) ASSERT_TRUE(reader.Read(&frame));
  PeopleDetectorOptions options;
  options.network = PoseNetworkSize::kFull;
  options.max_people = 1;
  options.masks = true;
  const auto all = PeopleDetector("", options).Detect(frames);
  const std::vector<char> second = {0, 1};
  const auto some = PeopleDetector("", options).Detect(frames, second);
  for (size_t f = 0; f < 2; ++f) {
    ASSERT_EQ(all[f].size(), 1U);
    ASSERT_EQ(some[f].size(), 1U);
    const DetectedPose &a = all[f][0], &b = some[f][0];
    EXPECT_EQ(a.presence, b.presence);
    ASSERT_EQ(a.landmarks.size(), b.landmarks.size());
    for (size_t k = 0; k < a.landmarks.size(); ++k) {
      EXPECT_EQ(a.landmarks[k].pixel, b.landmarks[k].pixel);
      EXPECT_EQ(a.landmarks[k].visibility, b.landmarks[k].visibility);
    }
    EXPECT_FALSE(a.mask.labels.empty());
  }
  EXPECT_TRUE(some[0][0].mask.labels.empty());
  EXPECT_EQ(some[1][0].mask.labels, all[1][0].mask.labels);
  EXPECT_THROW((void)PeopleDetector("", options).Detect(frames, std::vector<char>{1}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::pose_detector_test
