// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/doubles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "tests/support/stick_person.h"

namespace bodyloom::doubles_test {
namespace {

constexpr double kHeight = 400;

class Clip {
 public:
  explicit Clip(int num_frames) {
    people_.convention = Coco17();
    people_.frames.resize(size_t(num_frames));
    for (int t = 0; t < num_frames; ++t) people_.timestamps.push_back(t / 30.0);
  }

  /// A walking person whose arms swing; one a frame in [begin, end). The detector errs by 1.5 % of the height.
  void Walk(int begin, int end, int identity, double x = 300, double height = kHeight, double phase = 0) {
    for (int t = begin; t < end; ++t) Add(t, identity, Person(t, x, height, phase));
  }
  void Add(int t, int identity, DetectedPerson person) {
    person.identity = identity;
    people_.frames[size_t(t)].push_back(std::move(person));
  }
  DetectedPerson Person(int t, double x, double height, double phase) {
    DetectedPerson person;
    std::normal_distribution<double> noise(0, 0.015 * height);
    for (const std::string& name : people_.convention.names) {
      auto [px, py] = StickLandmark(name, x + 3 * t, 500, height);
      const double side = name.starts_with("left_") ? 1 : -1;
      if (name.ends_with("wrist")) px += side * 0.15 * height * std::sin(0.3 * t + phase);
      if (name.ends_with("ankle")) px -= side * 0.15 * height * std::sin(0.3 * t + phase);
      const double u = noise(random_), v = noise(random_);
      person.points.push_back({float(px + u), float(py + v), 0.9F});
    }
    return person;
  }
  [[nodiscard]] const PeopleSequence& people() const { return people_; }
  [[nodiscard]] std::vector<PersonTrack> Tracks() const { return LinkPeople(people_); }

 private:
  PeopleSequence people_;
  std::mt19937_64 random_{7};
};

/// Left and right exchanged.
DetectedPerson Exchanged(const DetectedPerson& person) {
  DetectedPerson other = person;
  const std::vector<std::string>& names = Coco17().names;
  for (size_t k = 0; k + 1 < names.size(); ++k) {
    if (names[k].starts_with("left_")) std::swap(other.points[k], other.points[k + 1]);
  }
  return other;
}

/// Turned upside down in its box: wrists at the ankles, hips at the shoulders.
DetectedPerson UpsideDown(const DetectedPerson& person) {
  DetectedPerson other = person;
  const std::vector<std::string>& names = Coco17().names;
  const auto from = [&](const std::string& to, const std::string& name) {
    for (const std::string side : {"left_", "right_"}) {
      const auto index = [&](const std::string& n) { return std::find(names.begin(), names.end(), n) - names.begin(); };
      other.points[size_t(index(side + to))] = person.points[size_t(index(side + name))];
    }
  };
  from("wrist", "ankle"), from("elbow", "knee"), from("shoulder", "hip"), from("hip", "shoulder");
  from("knee", "elbow"), from("ankle", "wrist");
  for (size_t k = 0; k < 5; ++k) other.points[k] = person.points[size_t(11 + k % 2)];
  return other;
}

TEST(Doubles, ADoubleEndsAndFillsTheGapsOfTheLonger) {
  Clip clip(100);
  clip.Walk(0, 40, 1);
  clip.Walk(50, 100, 1);
  clip.Walk(20, 60, 2);
  const std::vector<PersonTrack> tracks = clip.Tracks();
  ASSERT_EQ(tracks.size(), 1U);
  EXPECT_EQ(tracks[0].joined, 1);
  ASSERT_EQ(tracks[0].detections.size(), 100U);
  for (int t = 0; t < 100; ++t) {
    const auto [frame, index] = tracks[0].detections[size_t(t)];
    EXPECT_EQ(frame, t);
    const int identity = clip.people().frames[size_t(t)][size_t(index)].identity;
    EXPECT_EQ(identity, t >= 40 && t < 50 ? 2 : 1) << t;
  }
}

TEST(Doubles, WithLeftAndRightExchangedItIsADoubleToo) {
  Clip clip(60);
  clip.Walk(0, 60, 1);
  for (int t = 10; t < 40; ++t) clip.Add(t, 2, Exchanged(clip.Person(t, 300, kHeight, 0)));
  const std::vector<PersonTrack> tracks = clip.Tracks();
  ASSERT_EQ(tracks.size(), 1U);
  EXPECT_EQ(tracks[0].joined, 1);
}

TEST(Doubles, ASkeletonUpsideDownInsideThePersonEndsAndFillsNoGap) {
  Clip clip(60);
  clip.Walk(0, 30, 1);
  clip.Walk(32, 60, 1);
  for (int t = 20; t < 40; ++t) clip.Add(t, 2, UpsideDown(clip.Person(t, 300, kHeight, 0)));
  const std::vector<PersonTrack> tracks = clip.Tracks();
  ASSERT_EQ(tracks.size(), 1U);
  EXPECT_EQ(tracks[0].joined, 1);
  EXPECT_EQ(tracks[0].detections.size(), 58U);
}

TEST(Doubles, PeopleOneBehindTheOtherStayTwo) {
  // At 4 and 4.7 m from the camera, half a shoulder aside, each with steps of their own.
  Clip clip(80);
  clip.Walk(0, 80, 1);
  clip.Walk(0, 60, 2, 300 + 0.12 * kHeight, 0.85 * kHeight, 2);
  EXPECT_EQ(clip.Tracks().size(), 2U);
  // A child before an adult.
  Clip family(80);
  family.Walk(0, 80, 1);
  family.Walk(0, 60, 2, 300, 0.6 * kHeight, 1);
  EXPECT_EQ(family.Tracks().size(), 2U);
}

TEST(Doubles, PeopleWhoMeetForMomentsStayTwo) {
  Clip clip(80);
  clip.Walk(0, 80, 1);
  for (int t = 0; t < 60; ++t) clip.Add(t, 2, clip.Person(t, t < 20 ? 300 : 700, kHeight, 0));
  EXPECT_EQ(clip.Tracks().size(), 2U);
}

TEST(Doubles, BoxesAloneAreNeverJoined) {
  PeopleSequence people;
  people.convention = {"corners", {"low", "high"}};
  for (int t = 0; t < 30; ++t) {
    people.timestamps.push_back(t / 30.0);
    people.frames.push_back({{{{100, 100, 1}, {200, 400, 1}}, 0}, {{{102, 101, 1}, {203, 402, 1}}, 1}});
  }
  EXPECT_EQ(LinkPeople(people).size(), 2U);
}

}  // namespace
}  // namespace bodyloom::doubles_test
