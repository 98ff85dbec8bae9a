// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/people_between.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

namespace bodyloom::people_between_test {
namespace {

/// Two landmarks 100 px apart, the upper one at (x, y).
DetectedPerson PersonAt(float x, float y, float confidence = 0.8F) {
  return {{{x, y, confidence}, {x, y + 100, confidence}}, -1};
}

/// Two people who pass each other: at second s, one at (100 + 60 s, 50), the other at (500 − 60 s, 250).
PeopleSequence Passing(const std::vector<double>& times) {
  PeopleSequence people;
  people.convention.names = {"nose", "left_hip"};
  people.image_width = people.image_height = 640;
  people.timestamps = times;
  for (const double s : times) {
    people.frames.push_back({PersonAt(float(100 + 60 * s), 50), PersonAt(float(500 - 60 * s), 250)});
  }
  return people;
}

TEST(FillBetween, SteadyMotionComesBackWhateverTheFramesAre) {
  const PeopleSequence truth = Passing({0, 0.1, 0.25, 0.3, 0.5, 0.55, 0.9});
  const std::vector<char> detected = {1, 0, 0, 1, 1, 0, 1};
  PeopleSequence people = truth;
  for (auto& frame : people.frames) {
    for (DetectedPerson& person : frame) person.hands_and_face = std::make_shared<const HandsAndFace>();
  }
  for (size_t t = 0; t < detected.size(); ++t) {
    if (!detected[t]) people.frames[t].clear();
  }
  FillBetween(detected, &people);
  for (size_t t = 0; t < detected.size(); ++t) {
    ASSERT_EQ(people.frames[t].size(), 2U) << t;
    for (const DetectedPerson& expected : truth.frames[t]) {
      const DetectedPerson& found =
          people.frames[t][std::abs(people.frames[t][0].points[0].y - expected.points[0].y) < 1 ? 0 : 1];
      EXPECT_EQ(found.hands_and_face != nullptr, detected[t] != 0) << t;
      for (size_t k = 0; k < 2; ++k) {
        EXPECT_NEAR(found.points[k].x, expected.points[k].x, 1e-3) << t;
        EXPECT_NEAR(found.points[k].y, expected.points[k].y, 1e-3) << t;
        EXPECT_NEAR(found.points[k].confidence, 0.8, 1e-6) << t;
      }
    }
  }
}

TEST(FillBetween, NobodyIsMadeUp) {
  // The second person leaves before the second detected frame; one landmark of the first is not seen there.
  PeopleSequence people = Passing({0, 0.1, 0.2, 0.3});
  people.frames[1].clear();
  people.frames[2].pop_back();
  people.frames[2][0].points[1].confidence = 0;
  people.frames[3].clear();
  FillBetween({1, 0, 1, 0}, &people);
  ASSERT_EQ(people.frames[1].size(), 1U);
  EXPECT_NEAR(people.frames[1][0].points[0].confidence, 0.8, 1e-6);
  EXPECT_EQ(people.frames[1][0].points[1].confidence, 0);
  EXPECT_TRUE(people.frames[3].empty());  // behind the last detected one
  EXPECT_THROW(FillBetween({1, 0}, &people), std::invalid_argument);
}

TEST(LargestStep, IsThatOfWhoeverGoesFarthestInTheirOwnSize) {
  const std::vector<DetectedPerson> before = {PersonAt(100, 50), PersonAt(500, 250)};
  // In another order: nearest people belong together.
  const std::vector<DetectedPerson> after = {PersonAt(500, 257), PersonAt(103, 54)};
  EXPECT_NEAR(LargestStep(before, after), 0.07, 1e-6);
  EXPECT_EQ(LargestStep(before, before), 0);
  EXPECT_TRUE(std::isinf(LargestStep(before, {PersonAt(100, 50)})));
  EXPECT_TRUE(std::isinf(LargestStep({}, {})));
}

}  // namespace
}  // namespace bodyloom::people_between_test
