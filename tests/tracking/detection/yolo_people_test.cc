// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/keypoint_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bodyloom::yolo_people_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// rows × anchors, empty at first.
class Output {
 public:
  Output(size_t rows, size_t anchors) : numbers_(rows * anchors, 0.0F), anchors_(anchors) {}
  void Set(size_t anchor, size_t first_row, const std::vector<float>& values) {
    for (size_t i = 0; i < values.size(); ++i) numbers_[(first_row + i) * anchors_ + anchor] = values[i];
  }
  [[nodiscard]] const std::vector<float>& numbers() const { return numbers_; }

 private:
  std::vector<float> numbers_;
  size_t anchors_;
};

/// The image is twice as large as the letterbox, in which it begins at (10, 20).
ImageCrop HalfSize() { return {.width = 640, .height = 640, .gain = {0.5, 0.5}, .shift = {10, 20}}; }

TEST(DecodeYolo, BoxesAndLandmarksComeBackToTheImage) {
  Output output(5 + 6, 3);
  output.Set(1, 0, {110, 220, 40, 100, 0.75F, 100, 200, 0.5F, 120, 240, 1.25F});
  const std::vector<YoloPerson> people = DecodeYolo(output.numbers(), 1, 2, HalfSize());
  ASSERT_EQ(people.size(), 1U);
  const YoloPerson& person = people[0];
  EXPECT_DOUBLE_EQ(person.box.x0, 160);
  EXPECT_DOUBLE_EQ(person.box.x1, 240);
  EXPECT_DOUBLE_EQ(person.box.y0, 300);
  EXPECT_DOUBLE_EQ(person.box.y1, 500);
  EXPECT_FLOAT_EQ(float(person.box.score), 0.75F);
  ASSERT_EQ(person.points.size(), 2U);
  EXPECT_EQ(person.points[0].x, 180);
  EXPECT_EQ(person.points[0].y, 360);
  EXPECT_EQ(person.points[0].confidence, 0.5F);
  EXPECT_EQ(person.points[1].x, 220);
  EXPECT_EQ(person.points[1].y, 440);
  EXPECT_EQ(person.points[1].confidence, 1);
}

TEST(DecodeYolo, OverlappingBoxesAreOnePerson) {
  // Boxes of 100 × 100: shifted by d they overlap by (100 − d) / (100 + d): d = 17 → 0.709, d = 18 → 0.695.
  Output output(5, 5);
  output.Set(0, 0, {200, 200, 100, 100, 0.5F});
  output.Set(1, 0, {217, 200, 100, 100, 0.9F});
  output.Set(2, 0, {235, 200, 100, 100, 0.7F});
  output.Set(3, 0, {500, 200, 100, 100, 0.25F});
  output.Set(4, 0, {500, 500, 100, 100, 0.24F});
  const std::vector<YoloPerson> people = DecodeYolo(output.numbers(), 1, 0, HalfSize());
  ASSERT_EQ(people.size(), 3U);
  EXPECT_DOUBLE_EQ((people[0].box.x0 + people[0].box.x1) / 2, 2 * (217 - 10));
  EXPECT_DOUBLE_EQ((people[1].box.x0 + people[1].box.x1) / 2, 2 * (235 - 10));
  EXPECT_DOUBLE_EQ((people[2].box.x0 + people[2].box.x1) / 2, 2 * (500 - 10));
}

TEST(DecodeYolo, TheSurestThreeHundred) {
  Output output(5, 301);
  for (size_t i = 0; i < 301; ++i) output.Set(i, 0, {float(100 * i), 0, 50, 50, i == 7 ? 0.5F : 0.6F});
  const std::vector<YoloPerson> people = DecodeYolo(output.numbers(), 1, 0, HalfSize());
  ASSERT_EQ(people.size(), 300U);
  EXPECT_GT(people.back().box.score, 0.55);
}

TEST(DecodeYolo, OfSeveralClassesThePersonIsTheFirst) {
  Output output(4 + 3, 3);
  output.Set(0, 0, {100, 100, 50, 50, 0.6F, 0.1F, 0.5F});
  output.Set(1, 0, {300, 100, 50, 50, 0.6F, 0.1F, 0.7F});
  output.Set(2, 0, {500, 100, 50, 50, 0.1F, 0.9F, 0.1F});
  const std::vector<YoloPerson> people = DecodeYolo(output.numbers(), 3, 0, HalfSize());
  ASSERT_EQ(people.size(), 1U);
  EXPECT_DOUBLE_EQ(people[0].box.x0, 2 * (75 - 10));
}

TEST(DecodeYolo, WhatIsNoNumberIsNoPerson) {
  Output output(5 + 3, 6);
  output.Set(0, 0, {100, 100, 50, 50, kNan, 1, 1, 1});
  output.Set(1, 0, {kNan, 100, 50, 50, 0.9F, 1, 1, 1});
  output.Set(2, 0, {100, 100, -50, 50, 0.9F, 1, 1, 1});
  output.Set(3, 0, {100, 100, INFINITY, 50, 0.9F, 1, 1, 1});
  output.Set(4, 0, {300, 300, 50, 50, 0.9F, kNan, 1, 1});
  output.Set(5, 0, {500, 300, 50, 50, 0.8F, 20, 20, kNan});
  const std::vector<YoloPerson> people = DecodeYolo(output.numbers(), 1, 1, HalfSize());
  ASSERT_EQ(people.size(), 2U);
  for (const YoloPerson& person : people) EXPECT_EQ(person.points[0].confidence, 0);
  EXPECT_EQ(people[0].points[0].x, 0);
}

TEST(DecodeYolo, OtherNumbersAreRefused) {
  EXPECT_THROW(DecodeYolo(std::vector<float>(57, 0.0F), 1, 17, HalfSize()), std::invalid_argument);
  EXPECT_THROW(DecodeYolo(std::vector<float>(56, 0.0F), 0, 17, HalfSize()), std::invalid_argument);
  EXPECT_TRUE(DecodeYolo({}, 1, 17, HalfSize()).empty());
}

}  // namespace
}  // namespace bodyloom::yolo_people_test
