// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/keypoint_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bodyloom::simcc_landmarks_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class Simcc : public ::testing::Test {
 protected:
  static constexpr size_t kLandmarks = 3, kColumns = 2 * 192, kRows = 2 * 256;

  void Set(size_t k, size_t column, float across, size_t row, float down) {
    columns_[k * kColumns + column] = across;
    rows_[k * kRows + row] = down;
  }
  [[nodiscard]] std::vector<Keypoint> Decoded() const { return DecodeSimcc(columns_, rows_, kLandmarks, 2, crop_); }

  std::vector<float> columns_ = std::vector<float>(kLandmarks * kColumns, -0.5F),
                     rows_ = std::vector<float>(kLandmarks * kRows, -0.5F);
  /// 375 × 500 pixels from (62.5, 50) on.
  ImageCrop crop_ = TopDownCrop({200, 100, 300, 500, 1}, 192, 256);
};

TEST_F(Simcc, TheLargestScoresAreThePlace) {
  Set(0, 192, 0.75F, 256, 0.5F);
  Set(1, 0, 2, 511, 3);
  Set(2, 383, 0.25F, 0, 0.5F);
  const std::vector<Keypoint> points = Decoded();
  ASSERT_EQ(points.size(), 3U);
  EXPECT_FLOAT_EQ(points[0].x, 250);  // the middle of the box
  EXPECT_FLOAT_EQ(points[0].y, 300);
  EXPECT_EQ(points[0].confidence, 0.5F);  // the smaller one
  EXPECT_FLOAT_EQ(points[1].x, 62.5F);
  EXPECT_NEAR(points[1].y, 50 + 255.5 * 500 / 256, 1e-4);
  EXPECT_EQ(points[1].confidence, 1);
  EXPECT_NEAR(points[2].x, 62.5 + 191.5 * 375 / 192, 1e-4);
  EXPECT_EQ(points[2].confidence, 0.25F);
}

TEST_F(Simcc, WithoutAPositiveScoreThereIsNoLandmark) {
  Set(0, 10, 0, 10, 0.5F);
  Set(1, 10, 0.5F, 10, -0.1F);
  for (size_t i = 0; i < kColumns; ++i) columns_[2 * kColumns + i] = kNan;
  Set(2, 5, kNan, 10, 0.5F);
  for (const Keypoint& point : Decoded()) EXPECT_EQ(point.confidence, 0);
  // One score that is not a number does not hide the others.
  Set(2, 7, 0.5F, 10, 0.5F);
  const Keypoint seen = Decoded()[2];
  EXPECT_EQ(seen.confidence, 0.5F);
  EXPECT_NEAR(seen.x, 62.5 + 3.5 * 375 / 192, 1e-4);
}

TEST_F(Simcc, OtherNumbersAreRefused) {
  rows_.pop_back();
  EXPECT_THROW(Decoded(), std::invalid_argument);
  EXPECT_THROW(DecodeSimcc({}, {}, 0, 2, crop_), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::simcc_landmarks_test
