// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/person_detection.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace bodyloom::person_detection_test {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

struct Outputs {
  std::vector<float> boxes = std::vector<float>(2254 * 12, 0.0F);
  std::vector<float> logits = std::vector<float>(2254, -50.0F);

  /// A detection by one anchor: a box of 22.4 pixels, points to the right of the anchor by 5, 10, 15 and 20 of them.
  void Set(int anchor, float logit, float dx = 0, float dy = 0) {
    float* b = &boxes[size_t(anchor) * 12];
    b[0] = dx, b[1] = dy, b[2] = b[3] = 22.4F;
    for (int p = 0; p < 4; ++p) b[4 + 2 * p] = dx + 5.0F * float(p + 1), b[5 + 2 * p] = dy;
    logits[size_t(anchor)] = logit;
  }
  [[nodiscard]] std::vector<PersonDetection> Decoded() const { return DecodePersonDetections(boxes, logits); }
};

double Sigmoid(double x) { return 1 / (1 + std::exp(-x)); }

TEST(PersonDetection, AnchorsLieInTheMiddleOfTheirCells) {
  // First cell of each grid; the last anchor of all; a cell to see that columns run before rows.
  const std::vector<std::pair<int, Eigen::Vector2d>> expected = {{0, {0.5 / 28, 0.5 / 28}},
                                                                 {1, {0.5 / 28, 0.5 / 28}},
                                                                 {2, {1.5 / 28, 0.5 / 28}},
                                                                 {2 * 28, {0.5 / 28, 1.5 / 28}},
                                                                 {1568, {0.5 / 14, 0.5 / 14}},
                                                                 {1568 + 392, {0.5 / 7, 0.5 / 7}},
                                                                 {1568 + 392 + 6, {1.5 / 7, 0.5 / 7}},
                                                                 {2253, {6.5 / 7, 6.5 / 7}}};
  for (const auto& [anchor, centre] : expected) {
    Outputs outputs;
    outputs.Set(anchor, 2);
    const std::vector<PersonDetection> people = outputs.Decoded();
    ASSERT_THAT(people, SizeIs(1)) << anchor;
    EXPECT_TRUE(people[0].box_min.isApprox(centre - Eigen::Vector2d(0.05, 0.05), 1e-6)) << anchor;
    EXPECT_TRUE(people[0].box_max.isApprox(centre + Eigen::Vector2d(0.05, 0.05), 1e-6)) << anchor;
    for (int p = 0; p < 4; ++p) {
      EXPECT_TRUE(people[0].points[p].isApprox(centre + Eigen::Vector2d(5.0 * (p + 1) / 224, 0), 1e-6));
    }
    EXPECT_NEAR(people[0].score, Sigmoid(2), 1e-12);
  }
}

TEST(PersonDetection, OverlappingDetectionsAreOnePersonWeightedByScore) {
  Outputs outputs;
  outputs.Set(600, 1, 0);
  outputs.Set(601, 3, 4);  // the same anchor's place, 4 pixels to the right: overlap 0.7
  const std::vector<PersonDetection> people = outputs.Decoded();
  ASSERT_THAT(people, SizeIs(1));
  EXPECT_NEAR(people[0].score, Sigmoid(3), 1e-12);
  const double anchor = (600 / 2 % 28 + 0.5) / 28;
  const double shift = 4.0 / 224 * Sigmoid(3) / (Sigmoid(1) + Sigmoid(3));
  EXPECT_NEAR(people[0].points[0].x(), anchor + 5.0 / 224 + shift, 1e-7);
  EXPECT_NEAR(people[0].box_min.x(), anchor - 0.05 + shift, 1e-7);
}

TEST(PersonDetection, PeopleApartStayApartBestFirst) {
  Outputs outputs;
  outputs.Set(100, 1);
  outputs.Set(1000, 3);
  const std::vector<PersonDetection> people = outputs.Decoded();
  ASSERT_THAT(people, SizeIs(2));
  EXPECT_GT(people[0].score, people[1].score);
}

TEST(PersonDetection, WhatIsUnsureNegativeOrNotANumberIsNobody) {
  Outputs outputs;
  outputs.Set(100, -0.01F);
  EXPECT_THAT(outputs.Decoded(), IsEmpty()) << "below one half";
  outputs.Set(100, 0.01F);
  EXPECT_THAT(outputs.Decoded(), SizeIs(1));
  outputs.boxes[100 * 12 + 2] = -1;
  EXPECT_THAT(outputs.Decoded(), IsEmpty()) << "a negative width";
  outputs.Set(100, std::numeric_limits<float>::quiet_NaN());
  EXPECT_THAT(outputs.Decoded(), IsEmpty());
  outputs.Set(100, std::numeric_limits<float>::infinity());
  EXPECT_THAT(outputs.Decoded(), SizeIs(1)) << "logits are limited";
  outputs.boxes[100 * 12 + 7] = std::numeric_limits<float>::infinity();
  EXPECT_THAT(outputs.Decoded(), IsEmpty());
  EXPECT_THROW(DecodePersonDetections(std::vector<float>(12), outputs.logits), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::person_detection_test
