// SPDX-License-Identifier: Apache-2.0
#include "pipelines/detect/upright_people.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace bodyloom::upright_people_test {
namespace {

using ::testing::HasSubstr;

/// A person whose trunk is turned clockwise in the image.
DetectedPerson Turned(double degrees, float confidence = 0.9F) {
  DetectedPerson person;
  person.points.assign(17, Keypoint{});
  const double angle = degrees * M_PI / 180;
  const auto place = [&](int k, double right, double up) {
    person.points[size_t(k)] = {float(300 + right * std::cos(angle) + up * std::sin(angle)),
                                float(200 + right * std::sin(angle) - up * std::cos(angle)), confidence};
  };
  place(5, 20, 60), place(6, -20, 60), place(11, 15, 0), place(12, -15, 0);  // COCO's shoulders and hips
  return person;
}

PeopleSequence Clip(const std::vector<DetectedPerson>& people) {
  PeopleSequence clip;
  clip.convention = Coco17();
  clip.frames.assign(people.size(), {});
  for (size_t t = 0; t < people.size(); ++t) clip.frames[t] = {people[t]};
  return clip;
}

TEST(UprightPeople, WithinFortyFiveDegrees) {
  for (const double degrees : {0.0, 40.0, -40.0}) EXPECT_TRUE(TrunkOf(Turned(degrees), Coco17()).is_upright);
  for (const double degrees : {50.0, -50.0, 90.0, 180.0, -90.0}) {
    EXPECT_FALSE(TrunkOf(Turned(degrees), Coco17()).is_upright) << degrees;
  }
  EXPECT_NEAR(TrunkOf(Turned(0), Coco17()).confidence, 0.9, 1e-6);
  KeypointConvention other;
  other.names = {"nose"};
  EXPECT_THROW(TrunkOf(Turned(0), other), std::invalid_argument);
}

TEST(UprightPeople, AdviceWhereMostLie) {
  EXPECT_THAT(AdviceOnTurn(Clip({Turned(90), Turned(95), Turned(80), Turned(0)})), HasSubstr("--rotate auto"));
  EXPECT_EQ(AdviceOnTurn(Clip({Turned(90), Turned(95), Turned(0)})), "") << "a third of them are upright";
  EXPECT_EQ(AdviceOnTurn(Clip({Turned(0), Turned(10)})), "");
  EXPECT_EQ(AdviceOnTurn(Clip({Turned(90, 0.2F)})), "") << "hardly seen";
  EXPECT_EQ(AdviceOnTurn(Clip({})), "");
}

}  // namespace
}  // namespace bodyloom::upright_people_test
