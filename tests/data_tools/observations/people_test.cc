// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <algorithm>
#include <random>
#include <string>

#include <cmath>
#include <limits>

#include "data_tools/observations/people.h"

#include "data_tools/observations/frame_numbers.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/support/stick_person.h"

namespace bodyloom::people_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

DetectedPerson Stick(double x, double height_px, float confidence = 0.9F) {
  DetectedPerson person;
  for (const std::string& name : Coco17().names) {
    const auto [px, py] = StickLandmark(name, x, 500, height_px);
    person.points.push_back({static_cast<float>(px), static_cast<float>(py), confidence});
  }
  return person;
}

PeopleSequence Clip(int num_frames) {
  PeopleSequence people;
  people.convention = Coco17();
  people.frames.resize(num_frames);
  for (int t = 0; t < num_frames; ++t) people.timestamps.push_back(t / 30.0);
  return people;
}

TEST(People, TwoPeopleWhoseOrderChangesStayApart) {
  PeopleSequence people = Clip(40);
  for (int t = 0; t < 40; ++t) {
    people.frames[t] = {Stick(300 + 5 * t, 400), Stick(900 - 3 * t, 300)};
    if (t % 3 == 1) std::swap(people.frames[t][0], people.frames[t][1]);
  }
  const KeypointSequence big = SelectPerson(people, 0, "p"), small = SelectPerson(people, 1, "p");
  for (int t = 0; t < 40; ++t) {
    EXPECT_NEAR(big.at(t, 0).x, 300 + 5 * t, 1e-2);
    EXPECT_NEAR(small.at(t, 0).x, 900 - 3 * t, 1e-2);
  }
  EXPECT_THAT(FileErrorOf("p", [&] { SelectPerson(people, 2, "p"); }), HasSubstr("only 2 were found"));
}

TEST(People, AGapIsBridgedAndABlipIsNot) {
  PeopleSequence people = Clip(100);
  for (int t = 0; t < 100; ++t) {
    if (t < 30 || t >= 60) people.frames[t].push_back(Stick(300 + 2 * t, 400));
    if (t == 40) people.frames[t].push_back(Stick(1700, 100));
  }
  const std::vector<PersonTrack> tracks = LinkPeople(people);
  ASSERT_EQ(tracks.size(), 2U);
  EXPECT_EQ(tracks[0].detections.size(), 70U);
  const KeypointSequence sequence = SelectPerson(people, 0, "p");
  EXPECT_EQ(sequence.at(40, 0).confidence, 0) << "missing, not the blip";
  EXPECT_NEAR(sequence.at(99, 0).x, 300 + 198, 1e-2);
}

TEST(People, IdentitiesOfTheDetectorWin) {
  PeopleSequence people = Clip(4);
  for (int t = 0; t < 4; ++t) {
    people.frames[t] = {Stick(300, 400), Stick(420, 390)};
    people.frames[t][0].identity = t < 2 ? 1 : 2;
    people.frames[t][1].identity = t < 2 ? 2 : 1;
  }
  const KeypointSequence sequence = SelectPerson(people, 0, "p");
  EXPECT_NE(sequence.at(1, 0).x, sequence.at(2, 0).x);
  EXPECT_EQ(LinkPeople(people).size(), 2U);
}

TEST(People, ConfidencesAreClampedAndNaNsMissing) {
  PeopleSequence people = Clip(1);
  people.frames[0] = {Stick(300, 400, 3.5F)};
  people.frames[0][0].points[4].x = std::numeric_limits<float>::quiet_NaN();
  people.frames[0][0].points[5].confidence = -1;
  const KeypointSequence sequence = SelectPerson(people, 0, "p");
  EXPECT_EQ(sequence.at(0, 0).confidence, 1);
  EXPECT_EQ(sequence.at(0, 4).confidence, 0);
  EXPECT_EQ(sequence.at(0, 4).x, 0);
  EXPECT_EQ(sequence.at(0, 5).confidence, 0);
}

TEST(People, ALandmarkThatIsNoNumberIsMissing) {
  const double nan = std::nan("");
  for (const Keypoint& p : {DetectedKeypoint(nan, 2, 1), DetectedKeypoint(1, nan, 1), DetectedKeypoint(1, 2, nan),
                            DetectedKeypoint(INFINITY, 2, 1), DetectedKeypoint(1e300, 2, 1)}) {
    EXPECT_EQ(p.confidence, 0);
    EXPECT_EQ(p.x, 0);
  }
  EXPECT_EQ(DetectedKeypoint(1, 2, 0.5).y, 2);
}

TEST(People, NobodyIsAnError) {
  const PeopleSequence people = Clip(3);
  EXPECT_THAT(FileErrorOf("p.json", [&] { SelectPerson(people, 0, "p.json"); }), HasSubstr("no person in any of 3"));
}

TEST(FrameNumbers, FromNames) {
  EXPECT_EQ(FrameNumberFromName("walk_000000000012_keypoints.json"), 12);
  EXPECT_EQ(FrameNumberFromName("a/b2/cam01.0037.json"), 37);
  EXPECT_EQ(FrameNumberFromName("cam01.0037"), 37);
  EXPECT_EQ(FrameNumberFromName("0.jpg"), 0);
  EXPECT_EQ(FrameNumberFromName("take3_keypoints.json"), 3);
  EXPECT_EQ(FrameNumberFromName("frame.json"), -1);
  EXPECT_EQ(FrameNumberFromName("12345678901234567890.json"), -1);
}

TEST(FrameNumbers, TheNumberThatVariesCounts) {
  EXPECT_THAT(FrameNumbersFromNames({"take2_60fps_7_1080p.json", "take2_60fps_12_1080p.json"}), ElementsAre(7, 12));
  EXPECT_THAT(FrameNumbersFromNames({"a1_7_x264.jpg", "a1_7_x264.jpg", "a1_8_x264.jpg"}), ElementsAre(7, 7, 8));
  EXPECT_THAT(FrameNumbersFromNames({"cam1_3.json", "cam2_4.json"}), ElementsAre(3, 4)) << "the last that varies";
  EXPECT_THAT(FrameNumbersFromNames({"take2_60fps_7_1080p.json"}), ElementsAre(1080)) << "one name tells nothing";
  EXPECT_THAT(FrameNumbersFromNames({"1_1080p.json", "x_1080p.json"}), ElementsAre(1080, 1080));
  EXPECT_THAT(FrameNumbersFromNames({"a.json", "b2.json"}), ElementsAre(-1, 2));
  EXPECT_THAT(FrameNumbersFromNames({}), ElementsAre());
  EXPECT_THAT(NumbersOrOrder({"a.json", "b2.json"}), ElementsAre(0, 1));
}

TEST(FrameNumbers, Grid) {
  const FrameGrid grid = MakeFrameGrid({30, 10, 15}, 10, "g");
  EXPECT_THAT(grid.index, ElementsAre(4, 0, 1));
  ASSERT_EQ(grid.timestamps.size(), 5U);
  EXPECT_NEAR(grid.timestamps[4], 3.0, 1e-12);
  EXPECT_THAT(FileErrorOf("g", [] { MakeFrameGrid({1, 2, 1}, 10, "g"); }), HasSubstr("occurs twice"));
  EXPECT_THAT(FileErrorOf("g", [] { MakeFrameGrid({0, 1, 100'000'000}, 10, "g"); }), HasSubstr("at most"));
  EXPECT_THROW(MakeFrameGrid({1}, 0, "g"), std::invalid_argument);
  EXPECT_THROW(MakeFrameGrid({1}, std::nan(""), "g"), std::invalid_argument);
}

constexpr double kHeight = 400;

class DoubledClip {
 public:
  explicit DoubledClip(int num_frames) {
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
  DoubledClip clip(100);
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
  DoubledClip clip(60);
  clip.Walk(0, 60, 1);
  for (int t = 10; t < 40; ++t) clip.Add(t, 2, Exchanged(clip.Person(t, 300, kHeight, 0)));
  const std::vector<PersonTrack> tracks = clip.Tracks();
  ASSERT_EQ(tracks.size(), 1U);
  EXPECT_EQ(tracks[0].joined, 1);
}

TEST(Doubles, ASkeletonUpsideDownInsideThePersonEndsAndFillsNoGap) {
  DoubledClip clip(60);
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
  DoubledClip clip(80);
  clip.Walk(0, 80, 1);
  clip.Walk(0, 60, 2, 300 + 0.12 * kHeight, 0.85 * kHeight, 2);
  EXPECT_EQ(clip.Tracks().size(), 2U);
  // A child before an adult.
  DoubledClip family(80);
  family.Walk(0, 80, 1);
  family.Walk(0, 60, 2, 300, 0.6 * kHeight, 1);
  EXPECT_EQ(family.Tracks().size(), 2U);
}

TEST(Doubles, PeopleWhoMeetForMomentsStayTwo) {
  DoubledClip clip(80);
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

}  // namespace bodyloom::people_test
