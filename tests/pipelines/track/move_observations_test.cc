// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/detected_people.h"

#include <gtest/gtest.h>

namespace bodyloom::move_observations_test {
namespace {

/// A video of half the camera's size, shifted by a few of its pixels.
Matrix2x3d HalfSize() { return (Matrix2x3d() << 0.5, 0, 3, 0, 0.5, -2).finished(); }

TEST(MoveObservations, KeypointsGoBackThroughTheMap) {
  KeypointSequence keypoints;
  keypoints.names = {"nose", "left_eye"};
  keypoints.timestamps = {0};
  keypoints.points = {{13, 8, 0.7F}, {3, -2, 1}};
  const KeypointSequence moved = MovedToCamera(keypoints, HalfSize(), 200, 160);
  EXPECT_FLOAT_EQ(moved.points[0].x, 20);
  EXPECT_FLOAT_EQ(moved.points[0].y, 20);
  EXPECT_FLOAT_EQ(moved.points[0].confidence, 0.7F);
  EXPECT_FLOAT_EQ(moved.points[1].x, 0);
  EXPECT_FLOAT_EQ(moved.points[1].y, 0);
  EXPECT_EQ(moved.image_width, 200);
  EXPECT_EQ(moved.image_height, 160);
}

TEST(MoveObservations, EachPixelOfTheCameraTakesTheLabelAtItsPlace) {
  PartLabelSequence labels;
  labels.image_width = 100;
  labels.image_height = 80;
  labels.timestamps = {0, 1};
  labels.frames = {LabelImage{.x_begin = 20, .y_begin = 30, .width = 2, .height = 1, .labels = {5, 9}}, {}};
  const PartLabelSequence moved = MovedToCamera(labels, HalfSize(), 200, 160);
  EXPECT_EQ(moved.image_width, 200);
  EXPECT_TRUE(moved.frames[1].empty());
  int labelled = 0;
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 200; ++x) {
      const double u = 0.5 * x + 3, v = 0.5 * y - 2;
      const int expected = labels.frames[0].At(int(std::lround(u)), int(std::lround(v)));
      ASSERT_EQ(moved.frames[0].At(x, y), expected) << x << ", " << y;
      labelled += expected > 0 ? 1 : 0;
    }
  }
  EXPECT_EQ(labelled, 8) << "two pixels of the video are eight of the camera";
}

TEST(MoveObservations, WhatLeavesTheCamerasImageIsCutOff) {
  PartLabelSequence labels;
  labels.image_width = labels.image_height = 100;
  labels.timestamps = {0};
  labels.frames = {LabelImage{0, 0, 100, 100, std::vector<uint8_t>(10000, 1)}};
  const LabelImage moved = MovedToCamera(labels, HalfSize(), 50, 40).frames[0].Unpacked();
  EXPECT_EQ(moved.x_begin, 0);
  EXPECT_EQ(moved.y_begin, 3) << "the video begins 1.5 of its pixels below the camera's first row";
  EXPECT_LE(moved.width, 50);
  EXPECT_LE(moved.height, 40);
  EXPECT_EQ(moved.labels.size(), size_t(moved.width) * moved.height);
}

}  // namespace
}  // namespace bodyloom::move_observations_test
