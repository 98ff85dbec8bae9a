// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/detection_readers.h"

#include <gmock/gmock.h>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/observations/load_detections.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/stick_person.h"

namespace bodyloom::ultralytics_reader_test {
namespace {

using ::testing::HasSubstr;

/// A detection as Results.to_json() writes one: COCO's landmarks of a person at x, left ear unseen.
std::string Detection(double x, int track_id, size_t count = 17, bool has_confidence = true) {
  std::string xs, ys, cs;
  for (size_t k = 0; k < count; ++k) {
    const std::string& name = CocoWholeBody23().names[std::min<size_t>(k, 22)];
    const auto [px, py] = StickLandmark(name, x, 500, 400);
    const bool hidden = k == 3;
    xs += (k > 0 ? "," : "") + std::to_string(hidden ? 0 : px);
    ys += (k > 0 ? "," : "") + std::to_string(hidden ? 0 : py);
    cs += (k > 0 ? "," : "") + std::string(hidden ? "0.3" : "0.75");
  }
  return R"({"name":"person","class":0,"confidence":0.9,"box":{"x1":1,"y1":2,"x2":3,"y2":4},)" +
         (track_id >= 0 ? R"("track_id":)" + std::to_string(track_id) + "," : std::string()) + R"("keypoints":{"x":[)" +
         xs + R"(],"y":[)" + ys + "]" + (has_confidence ? R"(,"visible":[)" + cs + "]" : std::string()) + "}}";
}

KeypointSequence Load(const std::string& text, int person = 0) {
  LoadDetectionsOptions options;
  options.person = person;
  options.fps = 10;
  return DetectionsFromBytes(text, "u.json", options);
}
std::string ErrorOf(const std::string& text) {
  return FileErrorOf("u.json", [&] { Load(text); });
}

void ExpectStick(const KeypointSequence& sequence, int t, double x) {
  ASSERT_LT(t, sequence.num_frames());
  EXPECT_EQ(sequence.convention, "coco17");
  for (int k = 0; k < 17; ++k) {
    const auto [px, py] = StickLandmark(Coco17().names[size_t(k)], x, 500, 400);
    EXPECT_EQ(sequence.at(t, k).confidence, k == 3 ? 0 : 0.75F) << "(0, 0) is a landmark that was not seen";
    if (k == 3) continue;
    EXPECT_NEAR(sequence.at(t, k).x, px, 1e-3);
    EXPECT_NEAR(sequence.at(t, k).y, py, 1e-3);
  }
}

TEST(Ultralytics, AListOfFramesAndJsonLines) {
  const std::string first = "[" + Detection(300, -1) + "]", last = "[" + Detection(320, -1) + "]";
  for (const std::string& text : {"[" + first + ",[]," + last + "]", first + "\n[]\n" + last + "\n"}) {
    const KeypointSequence sequence = Load(text);
    ASSERT_EQ(sequence.num_frames(), 3);
    ExpectStick(sequence, 0, 300);
    EXPECT_EQ(sequence.at(1, 0).confidence, 0);
    ExpectStick(sequence, 2, 320);
    EXPECT_NEAR(sequence.timestamps[2], 0.2, 1e-12);
  }
  ExpectStick(Load(first), 0, 300);  // one image
}

TEST(Ultralytics, TrackIdsJoinPeople) {
  // The two change places between frames, which only their identities tell.
  const std::string text =
      "[[" + Detection(300, 7) + "," + Detection(900, 4) + "],[" + Detection(310, 4) + "," + Detection(890, 7) + "]]";
  for (const int person : {0, 1}) {
    const KeypointSequence sequence = Load(text, person);
    EXPECT_NEAR(std::abs(sequence.at(1, 0).x - sequence.at(0, 0).x), 590, 1e-2);
  }
}

TEST(Ultralytics, AFolderOfImages) {
  const TemporaryFolder folder;
  WriteFileAtomically(folder.File("img_3.json"), "[]");
  WriteFileAtomically(folder.File("img_4.json"), "[" + Detection(300, -1) + "]");
  WriteFileAtomically(folder.File("img_10.json"), "[" + Detection(310, -1));
  std::vector<std::string> warnings;
  LoadDetectionsOptions options;
  options.fps = 10;
  const KeypointSequence sequence = LoadDetections(folder.File(""), options, &warnings);
  ASSERT_EQ(sequence.num_frames(), 8);
  ExpectStick(sequence, 1, 300);
  EXPECT_EQ(warnings.size(), 1U);
}

TEST(Ultralytics, ConfidencesAndWholeBodies) {
  EXPECT_EQ(Load("[[" + Detection(300, -1, 17, false) + "]]").at(0, 0).confidence, 1);
  EXPECT_EQ(Load("[[" + Detection(300, -1, 133) + "]]").convention, "coco_wholebody23");
}

TEST(Ultralytics, RefusesWhatItIsNot) {
  EXPECT_THAT(ErrorOf("[[" + Detection(300, -1, 14) + "]]"), HasSubstr("14 landmarks, expected 17 (COCO)"));
  EXPECT_THAT(ErrorOf("[[" + Detection(300, -1) + "," + Detection(300, -1, 23) + "]]"), HasSubstr("as many as before"));
  EXPECT_THAT(ErrorOf(R"([[{"name":"person","class":0,"confidence":0.9,"box":{"x1":1}}]])"),
              HasSubstr("without 'keypoints', expected those of a pose model"));
  EXPECT_THAT(ErrorOf(R"([[{"keypoints":{"x":[1,2],"y":[1]}}]])"), HasSubstr("1 numbers, expected 2"));
  EXPECT_THAT(ErrorOf(R"([[{"keypoints":{"x":[1,"a"],"y":[1,2]}}]])"), HasSubstr("found string"));
  EXPECT_THAT(ErrorOf("[[" + Detection(300, -1) + "],5]"), HasSubstr("found number"));
  const std::string text = "[[" + Detection(300, 2) + "]]";
  for (size_t n = 0; n < text.size(); n += 7) ErrorOf(text.substr(0, n));
}

}  // namespace
}  // namespace bodyloom::ultralytics_reader_test
