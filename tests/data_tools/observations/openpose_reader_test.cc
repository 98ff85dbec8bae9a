// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/detection_readers.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "data_tools/formats/atomic_file.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/stick_person.h"

namespace bodyloom::openpose_reader_test {
namespace {

using ::testing::HasSubstr;

std::string Person(const std::string& numbers) {
  return R"({"person_id":[-1],"pose_keypoints_2d":[)" + numbers + R"(],"face_keypoints_2d":[]})";
}
std::string Frame(const std::string& people) { return R"({"version":1.3,"people":[)" + people + "]}"; }
std::string StickFrame(const KeypointConvention& convention, double x) {
  return Frame(Person(StickNumbers(convention.names, x, 500, 400)));
}

PeopleSequence Parse(const std::string& text, const std::string& convention = "") {
  const nlohmann::json json = ParseJson(text, "op.json");
  const JsonNode document(json, "op.json");
  EXPECT_TRUE(IsOpenPoseJson(document));
  return OpenPoseFromJson(document, 30, convention);
}

TEST(OpenPose, TellsTheModelsApart) {
  for (const KeypointConvention* convention : {&Body25(), &Body25B(), &OpenPoseCoco18(), &Coco17(), &Halpe26()}) {
    const PeopleSequence people = Parse(StickFrame(*convention, 600));
    EXPECT_EQ(people.convention.name, convention->name);
    ASSERT_EQ(people.frames.size(), 1U);
    ASSERT_EQ(people.frames[0].size(), 1U);
    for (size_t k = 0; k < convention->names.size(); ++k) {
      const auto [x, y] = StickLandmark(convention->names[k], 600, 500, 400);
      EXPECT_NEAR(people.frames[0][0].points[k].x, x, 1e-3);
      EXPECT_NEAR(people.frames[0][0].points[k].y, y, 1e-3);
      EXPECT_NEAR(people.frames[0][0].points[k].confidence, 0.9, 1e-6);
    }
  }
  EXPECT_EQ(Parse(StickFrame(Body25B(), 600), "body25").convention.name, "body25") << "a wish overrides detection";
}

TEST(OpenPose, FolderWithGapsEmptyPeopleAndEmptyObjects) {
  const TemporaryFolder folder;
  WriteFileAtomically(folder.File("walk_000000000007_keypoints.json"), StickFrame(Body25(), 100));
  WriteFileAtomically(folder.File("walk_000000000008_keypoints.json"), Frame(""));
  WriteFileAtomically(folder.File("walk_000000000010_keypoints.json"),
                      Frame("{}," + Person(StickNumbers(Body25().names, 130, 500, 400)) + "," + Person("")));
  const PeopleSequence people = ReadOpenPoseFolder(folder.File(""), 10);
  ASSERT_EQ(people.frames.size(), 4U);
  EXPECT_EQ(people.frames[0].size(), 1U);
  EXPECT_EQ(people.frames[1].size(), 0U);
  EXPECT_EQ(people.frames[2].size(), 0U) << "frame 9 has no file";
  EXPECT_EQ(people.frames[3].size(), 1U);
  EXPECT_NEAR(people.timestamps[0], 0.7, 1e-12);
  EXPECT_NEAR(people.timestamps[3], 1.0, 1e-12);
}

TEST(OpenPose, OneFileForms) {
  const std::string a = StickFrame(Body25(), 100), b = StickFrame(Body25(), 110);
  EXPECT_EQ(Parse("[" + a + "," + b + "]").frames.size(), 2U);
  const PeopleSequence table = Parse(R"({"12.jpg":)" + b + R"(,"9.jpg":)" + a + "}");
  ASSERT_EQ(table.frames.size(), 2U) << "every third frame is no gap";
  EXPECT_NEAR(table.timestamps[0], 0.3, 1e-12);
  EXPECT_LT(table.frames[0][0].points[0].x, table.frames[1][0].points[0].x);
  EXPECT_EQ(Parse(R"({"people":[{"pose_keypoints":[)" + StickNumbers(OpenPoseCoco18().names, 1, 2, 300) + "]}]}")
                .convention.name,
            "openpose_coco18");
}

TEST(OpenPose, MalformedFilesAreErrors) {
  const auto error = [](const std::string& text) { return FileErrorOf("op.json", [&] { Parse(text); }); };
  EXPECT_THAT(error(Frame(Person("1,2"))), HasSubstr("multiple of 3"));
  EXPECT_THAT(error(Frame(Person("1,2,0.5"))), HasSubstr("1 landmarks"));
  EXPECT_THAT(error(Frame(Person(StickNumbers(Body25().names, 1, 2, 300)) + "," +
                          Person(StickNumbers(Coco17().names, 1, 2, 300)))),
              HasSubstr("17 landmarks, expected 25"));
  EXPECT_THAT(error(R"({"people":5})"), HasSubstr("people: found number"));
  EXPECT_THAT(error(R"({"people":[5]})"), HasSubstr("people[0]: found number"));
  EXPECT_THAT(error(R"({"people":[{"pose_keypoints_2d":[1,"x",3]}]})"), HasSubstr("found string after 1 numbers"));
  EXPECT_THAT(FileErrorOf("op.json", [&] { Parse(StickFrame(Body25(), 1), "coco17"); }), HasSubstr("25 landmarks"));
  const TemporaryFolder folder;
  EXPECT_THAT(FileErrorOf(folder.File(""), [&] { ReadOpenPoseFolder(folder.File(""), 30); }), HasSubstr("no .json"));
  WriteFileAtomically(folder.File("a1.json"), "{");
  FileErrorOf("a1.json", [&] { ReadOpenPoseFolder(folder.File(""), 30); });
  FileErrorOf("nowhere", [&] { ReadOpenPoseFolder(folder.File("nowhere"), 30); });
}

TEST(OpenPose, EveryTruncationIsAnError) {
  const std::string text = StickFrame(Body25(), 100);
  for (size_t n = 0; n < text.size(); n += 7) {
    FileErrorOf("op.json", [&] {
      const nlohmann::json json = ParseJson(text.substr(0, n), "op.json");
      OpenPoseFromJson(JsonNode(json, "op.json"), 30);
    });
  }
}

}  // namespace
}  // namespace bodyloom::openpose_reader_test
