// SPDX-License-Identifier: Apache-2.0
#include "data_tools/datasets/body_truth.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "data_tools/datasets/photo_segmentation.h"
#include "data_tools/datasets/single_person_dataset.h"

namespace bodyloom::body_truth_test {
namespace {

constexpr int kWidth = 80, kHeight = 60;
constexpr size_t kArea = size_t(kWidth) * kHeight;
constexpr int kLeg = 9, kSleeve = 15, kHand = 3;

double Distance(size_t a, size_t b) {
  const size_t row_a = a / kWidth, row_b = b / kWidth;
  return std::hypot(double(a % kWidth) - double(b % kWidth), double(row_a) - double(row_b));
}

TEST(NearestMarked, IsAsNearAsTheNearest) {
  std::mt19937 random(3);
  std::vector<uint8_t> marked(kArea, 0);
  std::vector<size_t> places;
  for (int k = 0; k < 25; ++k) {
    places.push_back(random() % kArea);
    marked[places.back()] = static_cast<uint8_t>(1 + k);
  }
  const std::vector<int> nearest = NearestMarked(marked, kWidth, kHeight);
  for (size_t i = 0; i < kArea; ++i) {
    ASSERT_GE(nearest[i], 0);
    ASSERT_NE(marked[nearest[i]], 0);
    double minimum = 1e9;
    for (const size_t place : places) minimum = std::min(minimum, Distance(i, place));
    ASSERT_LE(Distance(i, nearest[i]), 1.03 * minimum) << i;
  }
  EXPECT_THAT(NearestMarked(std::vector<uint8_t>(kArea, 0), kWidth, kHeight), ::testing::Each(-1));
  EXPECT_THROW(NearestMarked(marked, kWidth, kHeight + 1), std::invalid_argument);
}

/// A bare body from column 20 to 59 of rows 10 to 49, a leg on its left and a sleeve on its right, which face left and
/// right; a person who reaches five pixels farther on all sides but the right, where six pixels of the body are not
/// hers.
struct Dressed {
  BodySurface body = {kWidth, kHeight, std::vector<uint8_t>(kArea, 0), std::vector<float>(3 * kArea, 0)};
  std::vector<uint8_t> person = std::vector<uint8_t>(kArea, 0);
  Dressed() {
    for (size_t i = 0; i < kArea; ++i) {
      const int x = static_cast<int>(i % kWidth), y = static_cast<int>(i / kWidth);
      if (x >= 20 && x < 60 && y >= 10 && y < 50) {
        body.parts[i] = x < 40 ? kLeg : kSleeve;
        body.normals[i] = x < 40 ? -0.6F : 0.6F;
        body.normals[2 * kArea + i] = -0.8F;
      }
      person[i] = x >= 15 && x < 54 && y >= 5 && y < 55 ? 1 : 0;
    }
  }
  static size_t At(int x, int y) { return size_t(y) * kWidth + x; }
};

uint8_t Label(int part) { return static_cast<uint8_t>(LabelOfPart(part)); }

TEST(BodyTruth, IsTheBodysWithinTheOutlineAndTheNearestBeyondIt) {
  const Dressed dressed;
  const BodyTruth truth = BodyTruthOf(dressed.body, dressed.person);
  for (size_t i = 0; i < kArea; ++i) {
    ASSERT_EQ(truth.labels[i] != 0, dressed.person[i] != 0) << i;
    const uint8_t* const code = &truth.normals.bgr[3 * i];
    if (dressed.person[i] == 0) {
      ASSERT_EQ(code[0] + code[1] + code[2], 0);
      continue;
    }
    const bool left = i % kWidth < 40;
    ASSERT_EQ(truth.labels[i], Label(left ? kLeg : kSleeve)) << i;
    ASSERT_NEAR(NormalOfCode(code[2]), left ? -0.6 : 0.6, 1.0 / 255);  // x is red
    ASSERT_NEAR(NormalOfCode(code[1]), 0, 1.0 / 255);
    ASSERT_NEAR(NormalOfCode(code[0]), -0.8, 1.0 / 255);
  }
}

TEST(BodyTruth, PartsThatSomebodyFoundCountBeforeTheBodys) {
  const Dressed dressed;
  std::vector<uint8_t> parts(kArea, 0);
  for (int y = 5; y < 30; ++y) std::fill_n(&parts[Dressed::At(15, y)], 39, kHand);
  parts[Dressed::At(20, 20)] = 255;  // not known: its neighbours are hands
  const BodyTruth truth = BodyTruthOf(dressed.body, dressed.person, parts);
  EXPECT_EQ(truth.labels[Dressed::At(20, 20)], Label(kHand));
  EXPECT_EQ(truth.labels[Dressed::At(50, 20)], Label(kHand));
  EXPECT_EQ(truth.labels[Dressed::At(50, 40)], Label(kHand)) << "the nearest that is known";
  EXPECT_EQ(truth.normals.bgr, BodyTruthOf(dressed.body, dressed.person).normals.bgr) << "normals are the body's";
  EXPECT_EQ(BodyTruthOf(dressed.body, dressed.person, std::vector<uint8_t>(kArea, 0)).labels,
            BodyTruthOf(dressed.body, dressed.person).labels)
      << "nobody found any";
}

TEST(BodyTruth, WithoutABodyAllIsBackground) {
  Dressed dressed;
  std::fill(dressed.body.parts.begin(), dressed.body.parts.end(), 0);
  const BodyTruth truth = BodyTruthOf(dressed.body, dressed.person);
  EXPECT_THAT(truth.labels, ::testing::Each(0));
  EXPECT_THAT(truth.normals.bgr, ::testing::Each(0));
  dressed.person.pop_back();
  EXPECT_THROW(BodyTruthOf(dressed.body, dressed.person), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::body_truth_test
