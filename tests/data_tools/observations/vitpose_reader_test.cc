// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/detection_readers.h"

#include <gmock/gmock.h>

#include "data_tools/observations/load_detections.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/support/stick_person.h"

namespace bodyloom::vitpose_reader_test {
namespace {

using ::testing::HasSubstr;

/// easy_ViTPose's 25: its own spellings, and ours.
const std::vector<std::string>& Names25() {
  static const std::vector<std::string> names = {
      "nose",           "left_eye",      "right_eye",      "left_ear",        "right_ear",
      "neck",           "left_shoulder", "right_shoulder", "left_elbow",      "right_elbow",
      "left_wrist",     "right_wrist",   "left_hip",       "right_hip",       "hip",
      "left_knee",      "right_knee",    "left_ankle",     "right_ankle",     "left_big toe",
      "left_small_toe", "left_heel",     "right_big_toe",  "right_small_toe", "right_heel"};
  return names;
}
std::string OurName(const std::string& name) {
  return name == "hip" ? "mid_hip" : name == "left_big toe" ? "left_big_toe" : name;
}

/// [[y, x, confidence], …]
std::string Person(const std::vector<std::string>& names, double x) {
  std::string text;
  for (const std::string& name : names) {
    const auto [px, py] = StickLandmark(OurName(name), x, 500, 400);
    text += (text.empty() ? "[" : ",[") + std::to_string(py) + "," + std::to_string(px) + ",0.75]";
  }
  return "[" + text + "]";
}
std::string File(const std::string& frames, const std::vector<std::string>& names) {
  std::string skeleton;
  for (size_t k = 0; k < names.size(); ++k) {
    skeleton += (k > 0 ? ",\"" : "\"") + std::to_string(k) + "\":\"" + names[k] + "\"";
  }
  return R"({"keypoints":[)" + frames + R"(],"skeleton":{)" + skeleton + "}}";
}
KeypointSequence Load(const std::string& text, int person = 0) {
  LoadDetectionsOptions options;
  options.person = person;
  options.fps = 10;
  return DetectionsFromBytes(text, "v.json", options);
}
std::string ErrorOf(const std::string& text) {
  return FileErrorOf("v.json", [&] { Load(text); });
}

TEST(VitPose, YComesFirstAndNamesGiveTheOrder) {
  for (const std::vector<std::string>& names : {CocoNames(), Names25()}) {
    const KeypointSequence sequence =
        Load(File(R"({"0":)" + Person(names, 300) + R"(},{},{"0":)" + Person(names, 310) + "}", names));
    ASSERT_EQ(sequence.num_frames(), 3);
    EXPECT_EQ(sequence.convention, names.size() == 17 ? "coco17" : "custom");
    for (size_t k = 0; k < names.size(); ++k) {
      EXPECT_EQ(sequence.names[k], OurName(names[k]));
      const auto [x, y] = StickLandmark(OurName(names[k]), 310, 500, 400);
      EXPECT_NEAR(sequence.at(2, int(k)).x, x, 1e-3);
      EXPECT_NEAR(sequence.at(2, int(k)).y, y, 1e-3);
      EXPECT_EQ(sequence.at(2, int(k)).confidence, 0.75F);
      EXPECT_EQ(sequence.at(1, int(k)).confidence, 0);
    }
  }
}

TEST(VitPose, PeopleByTheirNumbers) {
  const std::string a = Person(CocoNames(), 300), b = Person(CocoNames(), 900);
  // They change places, which only their numbers tell.
  const std::string text = File(R"({"3":)" + a + R"(,"8":)" + b + R"(},{"3":)" + b + R"(,"8":)" + a + "}", CocoNames());
  for (const int person : {0, 1}) {
    const KeypointSequence sequence = Load(text, person);
    EXPECT_NEAR(std::abs(sequence.at(1, 0).x - sequence.at(0, 0).x), 600, 1e-2);
  }
}

TEST(VitPose, WithoutAllNamesTheOrderIsCocos) {
  const std::string frames = R"({"0":)" + Person(CocoNames(), 300) + "}";
  EXPECT_EQ(Load(File(frames, {"nose"})).convention, "coco17");
  EXPECT_EQ(Load(File(frames, {})).convention, "coco17");
  EXPECT_THAT(ErrorOf(File(frames, {"L_Eye"})), HasSubstr("17 landmarks of which 'skeleton' names 1"));
}

TEST(VitPose, RefusesWhatItIsNot) {
  std::vector<std::string> animal;
  for (int k = 0; k < 17; ++k) animal.push_back("paw" + std::to_string(k));
  const std::string frames = R"({"0":)" + Person(CocoNames(), 300) + "}";
  EXPECT_THAT(ErrorOf(File(frames, animal)), HasSubstr("expected a person's landmarks"));
  EXPECT_THAT(ErrorOf(File(frames + R"(,{"0":[[1,2,3]]})", CocoNames())), HasSubstr("1 landmarks, expected 17"));
  EXPECT_THAT(ErrorOf(File(frames + ",5", CocoNames())), HasSubstr("found number"));
  EXPECT_THAT(ErrorOf(File(R"({"0":[[1,2,"c"]]})", {"nose"})), HasSubstr("v.json"));
  EXPECT_THAT(ErrorOf(File("{},{}", CocoNames())), HasSubstr("no person in any of 2 frames"));
  const std::string text = File(frames, CocoNames());
  for (size_t n = 0; n < text.size(); n += 7) ErrorOf(text.substr(0, n));
}

}  // namespace
}  // namespace bodyloom::vitpose_reader_test
