// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/people_npz.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "data_tools/observations/load_detections.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::people_npz_test {
namespace {

using ::testing::HasSubstr;

/// Somebody whose landmarks lie around (x, 100), 60 pixels apart at most.
DetectedPerson Somebody(float x, int identity) {
  DetectedPerson person;
  person.identity = identity;
  for (int k = 0; k < 33; ++k) person.points.push_back({x + float(k), 100 + 2 * float(k), 0.5F + 0.01F * float(k)});
  return person;
}

PeopleSequence Clip() {
  PeopleSequence people;
  people.convention = MediaPipe33();
  people.image_width = 640;
  people.image_height = 480;
  people.timestamps = {0, 0.04, 0.1};
  people.frames = {{Somebody(100, 4), Somebody(400, 9)}, {}, {Somebody(402, 9)}};
  return people;
}

TEST(PeopleNpz, EverybodyComesBack) {
  const TemporaryFolder folder;
  const PeopleSequence clip = Clip();
  WritePeople(folder.File("p.npz"), clip);
  const PeopleSequence read = PeopleFromNpz(ReadNpz(folder.File("p.npz")), "p.npz");
  EXPECT_EQ(read.timestamps, clip.timestamps);
  EXPECT_EQ(read.image_width, 640);
  EXPECT_EQ(read.image_height, 480);
  EXPECT_EQ(read.convention.name, "mediapipe33");
  EXPECT_EQ(read.convention.names, clip.convention.names);
  ASSERT_EQ(read.frames.size(), 3U);
  for (size_t t = 0; t < 3; ++t) {
    ASSERT_EQ(read.frames[t].size(), clip.frames[t].size());
    for (size_t i = 0; i < read.frames[t].size(); ++i) {
      EXPECT_EQ(read.frames[t][i].identity, clip.frames[t][i].identity);
      for (int k = 0; k < 33; ++k) {
        EXPECT_EQ(read.frames[t][i].points[k].x, clip.frames[t][i].points[k].x);
        EXPECT_EQ(read.frames[t][i].points[k].confidence, clip.frames[t][i].points[k].confidence);
      }
    }
  }
}

TEST(PeopleNpz, LoadDetectionsChoosesAPerson) {
  const TemporaryFolder folder;
  WritePeople(folder.File("p.npz"), Clip());
  const KeypointSequence longest = LoadDetections(folder.File("p.npz"));
  EXPECT_EQ(longest.at(2, 0).x, 402);
  EXPECT_EQ(longest.at(1, 0).confidence, 0);
  LoadDetectionsOptions options;
  options.person = 1;
  EXPECT_EQ(LoadDetections(folder.File("p.npz"), options).at(0, 0).x, 100);
  options.person = 2;
  EXPECT_THAT(FileErrorOf("p.npz", [&] { LoadDetections(folder.File("p.npz"), options); }),
              HasSubstr("only 2 were found"));
}

TEST(PeopleNpz, WhatDoesNotFitIsRefused) {
  const TemporaryFolder folder;
  WritePeople(folder.File("p.npz"), Clip());
  const NpzArrays good = ReadNpz(folder.File("p.npz"));
  const auto refusal = [&good](const std::string& key, const NdArray& array) {
    NpzArrays bad = good;
    bad[key] = array;
    return FileErrorOf("p.npz", [&bad] { PeopleFromNpz(bad, "p.npz"); });
  };
  const int32_t backwards[] = {0, 2, 1}, beyond[] = {0, 0, 3}, few[] = {0, 0}, strange[] = {-2, 0, 0};
  EXPECT_THAT(refusal("people_frame", NdArray::FromInts32(backwards, {3})), HasSubstr("not decreasing"));
  EXPECT_THAT(refusal("people_frame", NdArray::FromInts32(beyond, {3})), HasSubstr("entry 2 is 3"));
  EXPECT_THAT(refusal("people_identity", NdArray::FromInts32(few, {2})), HasSubstr("2 entries, expected the 3"));
  EXPECT_THAT(refusal("people_identity", NdArray::FromInts32(strange, {3})), HasSubstr("entry 0 is -2"));
  const std::vector<float> values(3 * 32 * 3);
  EXPECT_THAT(refusal("people_keypoints", NdArray::FromFloats(values.data(), {3, 32, 3})), HasSubstr("3 x 33 x 3"));
  EXPECT_THAT(refusal("people_keypoints", NdArray::FromString("x")), HasSubstr("people_keypoints"));
  NpzArrays missing = good;
  missing.erase("people_identity");
  EXPECT_THAT(FileErrorOf("p.npz", [&] { PeopleFromNpz(missing, "p.npz"); }), HasSubstr("people_identity"));
}

TEST(PeopleNpz, WritingChecksItsOwnData) {
  const TemporaryFolder folder;
  PeopleSequence clip = Clip();
  clip.frames[0][0].points.pop_back();
  EXPECT_THROW(WritePeople(folder.File("p.npz"), clip), std::invalid_argument);
  clip = Clip();
  clip.timestamps.pop_back();
  EXPECT_THROW(WritePeople(folder.File("p.npz"), clip), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::people_npz_test
