// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/frame_numbers.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace bodyloom::cut_frames_test {
namespace {

TEST(CutFrames, KeepsTheStretchWithItsTimes) {
  KeypointSequence keypoints;
  keypoints.names = {"nose", "left_eye"};
  PartLabelSequence labels;
  for (int t = 0; t < 5; ++t) {
    keypoints.timestamps.push_back(0.5 * t);
    for (int k = 0; k < 2; ++k) keypoints.points.push_back({float(10 * t + k), 0, 1});
    labels.timestamps.push_back(0.5 * t);
    labels.frames.emplace_back(LabelImage{t, 0, 1, 1, {1}});
  }
  const KeypointSequence cut = CutFrames(keypoints, 1, 3);
  ASSERT_EQ(cut.timestamps, (std::vector<double>{0.5, 1, 1.5}));
  ASSERT_EQ(cut.points.size(), 6U);
  EXPECT_EQ(cut.at(0, 0).x, 10);
  EXPECT_EQ(cut.at(2, 1).x, 31);
  const PartLabelSequence one = CutFrames(labels, 4, 4);
  ASSERT_EQ(one.timestamps, std::vector<double>{2});
  ASSERT_EQ(one.frames.size(), 1U);
  EXPECT_EQ(one.frames[0].Unpacked().x_begin, 4);
  EXPECT_THROW(CutFrames(keypoints, 3, 5), std::invalid_argument);
  EXPECT_THROW(CutFrames(keypoints, -1, 2), std::invalid_argument);
  EXPECT_THROW(CutFrames(labels, 3, 2), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::cut_frames_test
