// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/observation_pixels.h"

#include <gtest/gtest.h>

namespace bodyloom::observation_pixels_test {
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

TEST(MoveObservations, DenseKeypointsKeepTheirFaces) {
  DenseSequence dense;
  dense.timestamps = {0};
  dense.pixel_sigma_px = 3;
  dense.frames = {{DenseKeypoint{.face = 7, .pixel = {13, 8}, .sigma_px = 2}}};
  const DenseSequence moved = MovedToCamera(dense, HalfSize(), 200, 160);
  EXPECT_EQ(moved.frames[0][0].face, 7);
  EXPECT_TRUE(moved.frames[0][0].pixel.isApprox(Eigen::Vector2f(20, 20)));
  EXPECT_FLOAT_EQ(moved.frames[0][0].sigma_px, 4);
  EXPECT_DOUBLE_EQ(moved.pixel_sigma_px, 6);
  EXPECT_EQ(moved.image_width, 200);
}

TEST(MoveObservations, OnlyBetweenTheSizesOfAnAnamorphicVideo) {
  VideoInfo info;
  info.width = 1024, info.height = 576, info.stored_width = 720, info.stored_height = 576;
  const Camera square = MakePinhole(1024, 576, 900), stored = MakePinhole(720, 576, 900);
  KeypointSequence seen;
  seen.image_width = 720, seen.image_height = 576;
  seen.points = {{359.5F, 287.5F, 1}};
  KeypointSequence same = seen;
  EXPECT_FALSE(MoveToCamera(PixelsOf(info), stored, &same));
  EXPECT_EQ(same.points[0].x, 359.5F);
  ASSERT_TRUE(MoveToCamera(PixelsOf(info), square, &seen));
  EXPECT_FLOAT_EQ(seen.points[0].x, 511.5F) << "the centre stays the centre";
  EXPECT_FLOAT_EQ(seen.points[0].y, 287.5F);
  EXPECT_EQ(seen.image_width, 1024);
  ASSERT_TRUE(MoveToCamera(PixelsOf(info), stored, &seen));
  EXPECT_FLOAT_EQ(seen.points[0].x, 359.5F);
  seen.image_width = 640;
  EXPECT_FALSE(MoveToCamera(PixelsOf(info), stored, &seen)) << "another image altogether";
  EXPECT_FALSE(PixelsOf(VideoInfo{}).Differ({720, 576}, {1024, 576})) << "no video";
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
}  // namespace bodyloom::observation_pixels_test
