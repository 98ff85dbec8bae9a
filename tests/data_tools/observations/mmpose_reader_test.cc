// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/detection_readers.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/observations/load_detections.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/stick_person.h"

namespace bodyloom::mmpose_reader_test {
namespace {

using ::testing::HasSubstr;

/// A person as mmpose's split_instances() writes one; `extra` more zeros a point.
std::string Person(const std::vector<std::string>& names, double x, size_t count, const std::string& score = "0.8",
                   const std::string& extra = "") {
  std::string points, scores;
  for (size_t k = 0; k < count; ++k) {
    const auto [px, py] = StickLandmark(names[std::min(k, names.size() - 1)], x, 500, 400);
    points += (k == 0 ? "[" : ",[") + std::to_string(px) + "," + std::to_string(py) + extra + "]";
    scores += (k == 0 ? "" : ",") + score;
  }
  return R"({"keypoints":[)" + points + R"(],"keypoint_scores":[)" + scores +
         R"(],"bbox":[[0.0,0.0,10.0,10.0]],"bbox_score":0.9})";
}
std::string Coco(double x, const std::string& score = "0.8") { return Person(Coco17().names, x, 17, score); }
std::string Frame(int number, const std::string& people) {
  return R"({"frame_id":)" + std::to_string(number) + R"(,"instances":[)" + people + "]}";
}

LoadDetectionsOptions At(double fps, int person = 0) {
  LoadDetectionsOptions options;
  options.fps = fps;
  options.person = person;
  return options;
}
KeypointSequence Load(const std::string& text, int person = 0) {
  return DetectionsFromBytes(text, "m.json", At(25, person));
}
std::string ErrorOf(const std::string& text) {
  return FileErrorOf("m.json", [&] { Load(text); });
}

TEST(Mmpose, AVideoOfTheInferencerCountsFromZero) {
  const KeypointSequence sequence =
      Load("[" + Frame(0, Coco(300)) + "," + Frame(1, "") + "," + Frame(2, Coco(310, "1.04")) + "]");
  ASSERT_EQ(sequence.num_frames(), 3);
  EXPECT_EQ(sequence.convention, "coco17");
  EXPECT_NEAR(sequence.at(0, 0).x, 300, 1e-3);
  EXPECT_EQ(sequence.at(0, 0).confidence, 0.8F);
  EXPECT_EQ(sequence.at(1, 0).confidence, 0) << "a frame without anyone";
  EXPECT_EQ(sequence.at(2, 0).confidence, 1) << "SimCC's scores exceed 1 a little";
  EXPECT_EQ(sequence.timestamps[0], 0);
}

TEST(Mmpose, TheDemoScriptsCountFromOneAndNameTheirLandmarks) {
  const auto file = [](const std::string& first) {
    return R"({"meta_info":{"keypoint_id2name":{"0":")" + first +
           R"("},"sigmas":{"__ndarray__":[0.1],"dtype":"float32"}},)"
           R"("instance_info":[)" +
           Frame(1, Coco(300) + "," + Coco(900)) + "," + Frame(2, Coco(910) + "," + Coco(310)) + "]}";
  };
  for (const int person : {0, 1}) {
    const KeypointSequence sequence = Load(file("nose"), person);
    ASSERT_EQ(sequence.num_frames(), 2);
    EXPECT_EQ(sequence.timestamps[0], 0);
    EXPECT_NEAR(sequence.at(1, 0).x - sequence.at(0, 0).x, 10, 1e-3) << "people are followed, whatever their order";
  }
  EXPECT_THAT(ErrorOf(file("root")), HasSubstr("17 landmarks of which the first is 'root', expected COCO's"));
}

TEST(Mmpose, OneImageAndWholeBodies) {
  EXPECT_EQ(Load("[" + Coco(300) + "]").num_frames(), 1);
  const KeypointSequence whole = Load("[" + Person(CocoWholeBody23().names, 300, 133) + "]");
  EXPECT_EQ(whole.num_points(), 23);
  EXPECT_EQ(Load("[" + Person(Halpe26().names, 300, 26) + "]").convention, Halpe26().name);
}

TEST(Mmpose, AFolderOfImages) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.File("preds"));
  WriteFileAtomically(folder.File("preds/img_0003.json"), "[]");
  WriteFileAtomically(folder.File("preds/img_0004.json"), "[" + Coco(300) + "]");
  WriteFileAtomically(folder.File("preds/img_0005.json"), "[" + Coco(305) + "]");
  const KeypointSequence sequence = LoadDetections(folder.File("preds"), At(10));
  ASSERT_EQ(sequence.num_frames(), 3);
  EXPECT_EQ(sequence.at(0, 0).confidence, 0);
  EXPECT_NEAR(sequence.at(2, 0).x, 305, 1e-3);
  EXPECT_NEAR(sequence.timestamps[0], 0.3, 1e-12);
}

TEST(Mmpose, RefusesWhatItIsNot) {
  EXPECT_THAT(ErrorOf("[" + Frame(0, Person(Coco17().names, 300, 17, "0.8", ",0.5")) + "]"),
              HasSubstr("lifted to 3D, expected pixels"));
  EXPECT_THAT(ErrorOf("[" + Person(Coco17().names, 300, 14) + "]"), HasSubstr("14 landmarks, expected 17 (COCO)"));
  EXPECT_THAT(ErrorOf("[" + Coco(300) + "," + Person(Halpe26().names, 300, 26) + "]"), HasSubstr("as many as before"));
  EXPECT_THAT(ErrorOf("[" + Frame(0, Coco(300)) + "," + Frame(0, Coco(300)) + "]"), HasSubstr("m.json"));
  EXPECT_THAT(ErrorOf(R"({"instance_info":[{"frame_id":1}]})"), HasSubstr("instances"));
  EXPECT_THAT(ErrorOf(R"({"instance_info":{}})"), HasSubstr("a list of frames"));
  std::string few = Coco(300);
  few.replace(few.find("[0.8"), 5, "[");
  EXPECT_THAT(ErrorOf("[" + few + "]"), HasSubstr("keypoint_scores"));
}

}  // namespace
}  // namespace bodyloom::mmpose_reader_test
