// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/json_folder.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/observations/keypoint_conventions.h"
#include "data_tools/observations/load_detections.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/stick_person.h"

namespace bodyloom::json_folder_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string OpenPoseFrame(double x) {
  return R"({"version":1.3,"people":[{"person_id":[-1],"pose_keypoints_2d":[)" +
         StickNumbers(Body25().names, x, 500, 400) + "]}]}";
}

class JsonFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int t = 0; t < 9; ++t) Write(Name(t), OpenPoseFrame(100 + 10 * t));
  }
  void Write(const std::string& name, const std::string& bytes) { WriteFileAtomically(folder_.File(name), bytes); }
  static std::string Name(int t) { return "walk_00000000000" + std::to_string(t) + "_keypoints.json"; }
  KeypointSequence Load() {
    warnings_.clear();
    return LoadDetections(folder_.File(""), {.fps = 10}, &warnings_);
  }
  std::string Error() {
    return FileErrorOf(folder_.File(""), [&] { LoadDetections(folder_.File("")); });
  }

  TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

TEST_F(JsonFolder, FilesThatBeginWithADotArePassedOver) {
  Write("._" + Name(3), std::string("\0\5\26\7", 4));
  Write(".DS_Store", "x");
  Write(".hidden.json", "{");
  std::filesystem::create_directory(folder_.File(".views"));
  EXPECT_EQ(JsonFilesOf(folder_.File("")).size(), 9U);
  EXPECT_TRUE(FoldersOf(folder_.File("")).empty());
  const KeypointSequence sequence = Load();
  ASSERT_EQ(sequence.num_frames(), 9);
  EXPECT_NEAR(sequence.at(3, 0).x, 130, 1e-3);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(JsonFolder, ABrokenFileIsAFrameWithoutDetections) {
  Write(Name(0), "");
  Write(Name(4), OpenPoseFrame(140).substr(0, 200));
  Write(Name(8), "not JSON");
  const KeypointSequence sequence = Load();
  ASSERT_EQ(sequence.num_frames(), 9);
  for (const int t : {0, 4, 8}) EXPECT_EQ(sequence.at(t, 0).confidence, 0) << t;
  for (const int t : {1, 3, 5, 7}) EXPECT_NEAR(sequence.at(t, 0).x, 100 + 10 * t, 1e-3) << t;
  EXPECT_NEAR(sequence.timestamps[8], 0.8, 1e-12);
  EXPECT_THAT(warnings_, ElementsAre(AllOf(HasSubstr("3 of 9 files"), HasSubstr("the first " + Name(0)),
                                           HasSubstr(folder_.File("")))));
}

TEST_F(JsonFolder, MostFilesBrokenIsAnError) {
  for (int t = 0; t < 4; ++t) Write(Name(t), "{");
  EXPECT_EQ(Load().num_frames(), 9);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("4 of 9 files")));
  Write(Name(4), "");
  EXPECT_THAT(Error(), AllOf(HasSubstr(Name(0)), HasSubstr("more than half of the folder's 9 files")));
  for (int t = 0; t < 9; ++t) Write(Name(t), "");
  EXPECT_THAT(Error(), HasSubstr("the file is empty; more than half"));
}

TEST_F(JsonFolder, WholeJsonOfAnotherFormStaysAnError) {
  Write(Name(5), R"({"people":[{"pose_keypoints_2d":[1,2,0.5]}]})");
  EXPECT_THAT(Error(), AllOf(HasSubstr(Name(5)), HasSubstr("1 landmarks, expected 25")));
}

TEST_F(JsonFolder, TheNumberThatVariesIsTheFrames) {
  const TemporaryFolder folder;
  for (const int t : {9, 10, 12}) {
    WriteFileAtomically(folder.File("take2_60fps_" + std::to_string(t) + "_1080p.json"), OpenPoseFrame(100 + 10 * t));
  }
  const KeypointSequence sequence = LoadDetections(folder.File(""), {.fps = 10});
  ASSERT_EQ(sequence.num_frames(), 4);
  EXPECT_NEAR(sequence.timestamps[0], 0.9, 1e-12);
  EXPECT_NEAR(sequence.at(1, 0).x, 200, 1e-3) << "10 follows 9";
  EXPECT_EQ(sequence.at(2, 0).confidence, 0) << "frame 11 has no file";
}

TEST_F(JsonFolder, NanAndNullAreMissingLandmarks) {
  std::string frame = OpenPoseFrame(100);
  const size_t first = frame.find("[", frame.find("pose_keypoints_2d")) + 1;
  frame.replace(first, frame.find(',', first) - first, "NaN");
  Write(Name(2), frame);
  frame.replace(first, 3, "null");
  Write(Name(3), frame);
  const KeypointSequence sequence = Load();
  for (const int t : {2, 3}) {
    EXPECT_EQ(sequence.at(t, 0).confidence, 0);
    EXPECT_GT(sequence.at(t, 1).confidence, 0);
  }
  EXPECT_EQ(sequence.convention, "body25") << "recognised in spite of it";
}

}  // namespace
}  // namespace bodyloom::json_folder_test
