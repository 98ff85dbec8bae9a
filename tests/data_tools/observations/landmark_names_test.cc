// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/keypoint_conventions.h"

#include <gtest/gtest.h>

#include <map>

namespace bodyloom::landmark_names_test {
namespace {

TEST(LandmarkNames, SpellingsOfPeopleAndDetectors) {
  const std::map<std::string, std::string> expected = {
      {"nose", "nose"},
      {"Nose", "nose"},
      {"LEFT_FOOT_INDEX", "left_big_toe"},
      {"left_big toe", "left_big_toe"},
      {"RSmallToe", "right_small_toe"},
      {"LShoulder", "left_shoulder"},
      {"leftShoulder", "left_shoulder"},
      {"Left Shoulder", "left_shoulder"},
      {"shoulder_l", "left_shoulder"},
      {"elbow-R", "right_elbow"},
      {"REye", "right_eye"},
      {"LEFT_EYE_INNER", "left_eye_inner"},
      {"hip", "mid_hip"},
      {"Hips", "mid_hip"},
      {"MidHip", "mid_hip"},
      {"pelvis", "mid_hip"},
      {"left_hip", "left_hip"},
      {"thorax", "neck"},
      {"Neck", "neck"},
      {"tail_base", "tail_base"},
      {"ankle1", "ankle1"},
      {"L", "l"},
      {"", ""},
      {"--", ""},
  };
  for (const auto& [text, name] : expected) EXPECT_EQ(LandmarkNameFrom(text), name) << text;
  // The names of every convention stay what they are.
  for (const KeypointConvention* convention : KnownConventions()) {
    for (const std::string& name : convention->names) EXPECT_EQ(LandmarkNameFrom(name), name) << convention->name;
  }
}

TEST(LandmarkNames, ConventionsByTheirNames) {
  for (const KeypointConvention* convention : KnownConventions()) {
    EXPECT_EQ(ConventionOfNames(convention->names).name, convention->name);
  }
  std::vector<std::string> whole = CocoWholeBody23().names;
  while (whole.size() < 133) whole.push_back("face_" + std::to_string(whole.size()));
  EXPECT_EQ(ConventionOfNames(whole).name, "coco_wholebody23");
  EXPECT_EQ(ConventionOfNames(whole).names.size(), 23U);
  std::swap(whole[5], whole[6]);
  EXPECT_EQ(ConventionOfNames(whole).name, "custom") << "left and right exchanged";
  EXPECT_EQ(ConventionOfNames({"nose", "paw"}).names.size(), 2U);
  EXPECT_TRUE(IsPersonLandmark("left_knee"));
  EXPECT_TRUE(IsPersonLandmark("mid_hip"));
  EXPECT_FALSE(IsPersonLandmark("paw"));
}

}  // namespace
}  // namespace bodyloom::landmark_names_test
