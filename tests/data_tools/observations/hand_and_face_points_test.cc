// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/hand_and_face_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/npz.h"
#include "data_tools/observations/load_detections.h"
#include "data_tools/observations/people_npz.h"
#include "geometry/base/check.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/stick_person.h"

namespace bodyloom::hand_and_face_points_test {
namespace {

using ::testing::HasSubstr;

/// "x,y,c,…" of n points (x0 + k, y0 + 2 k), every one of them seen with 0.5.
std::string Numbers(int n, double x0, double y0, double gain = 1, double confidence = 0.5) {
  std::string text;
  for (int k = 0; k < n; ++k) {
    text += Concatenate(k > 0 ? "," : "", gain * (x0 + k), ",", gain * (y0 + 2 * k), ",", confidence);
  }
  return text;
}

LoadDetectionsOptions OfImage(int side) {
  LoadDetectionsOptions options;
  options.image_width = options.image_height = side;
  return options;
}

PersonDetections Load(const std::string& text, const LoadDetectionsOptions& options = {}) {
  const TemporaryFolder folder;
  WriteFileAtomically(folder.File("clip.json"), text);
  return LoadPersonDetections(folder.File("clip.json"), options);
}

/// Hands that begin at (300, 100) and (400, 200), a face at (500, 50), whose point k is the list's place[k].
void ExpectParts(const PersonDetections& person, float confidence,
                 const std::array<int, kFacePoints>* place = nullptr) {
  ASSERT_EQ(person.hands_and_face.num_frames(), person.body.num_frames());
  ASSERT_FALSE(person.hands_and_face.empty());
  const HandsAndFace& parts = *person.hands_and_face.frames[0];
  for (const auto side : {HandsAndFace::kLeft, HandsAndFace::kRight}) {
    ASSERT_TRUE(parts.hands[side]);
    for (int k = 0; k < kHandPoints; ++k) {
      const Keypoint& p = parts.hands[side]->points[size_t(k)];
      EXPECT_NEAR(p.x, (side == HandsAndFace::kLeft ? 300 : 400) + k, 1e-3);
      EXPECT_NEAR(p.y, (side == HandsAndFace::kLeft ? 100 : 200) + 2 * k, 1e-3);
      EXPECT_EQ(p.confidence, confidence);
      EXPECT_EQ(parts.hands[side]->sigma_px[size_t(k)], 0);
      EXPECT_TRUE(std::isnan(parts.hands[side]->metres[size_t(k)].x()));
    }
  }
  ASSERT_TRUE(parts.face);
  for (int k = 0; k < kFacePoints; ++k) {
    const int from = place != nullptr ? (*place)[size_t(k)] : k;
    EXPECT_NEAR(parts.face->points[size_t(k)].x, 500 + from, 1e-3);
    EXPECT_NEAR(parts.face->points[size_t(k)].y, 50 + 2 * from, 1e-3);
  }
}

std::string OpenPose(const std::string& parts) {
  return R"({"version":1.3,"people":[{"pose_keypoints_2d":[)" + StickNumbers(Body25().names, 600, 500, 400) + "]" +
         parts + "}]}";
}

TEST(HandAndFacePoints, OfOpenPose) {
  ExpectParts(
      Load(OpenPose(R"(,"hand_left_keypoints_2d":[)" + Numbers(21, 300, 100) + R"(],"hand_right_keypoints_2d":[)" +
                    Numbers(21, 400, 200) + R"(],"face_keypoints_2d":[)" + Numbers(70, 500, 50) + "]")),
      0.5F);
  EXPECT_TRUE(Load(OpenPose("")).hands_and_face.empty());
  EXPECT_TRUE(Load(OpenPose(R"(,"hand_left_keypoints_2d":[)" + Numbers(21, 0, 0, 0, 0) + R"(],"face_keypoints_2d":[])"))
                  .hands_and_face.empty())
      << "zeros are missing points";
  for (const auto& [parts, expected] :
       {std::pair(std::string(R"(,"hand_left_keypoints_2d":[)") + Numbers(20, 1, 1) + "]",
                  "20 points of the left hand, expected 21"),
        std::pair(std::string(R"(,"hand_right_keypoints_2d":[1,2])"), "2 numbers, expected a multiple of 3"),
        std::pair(std::string(R"(,"face_keypoints_2d":[)") + Numbers(69, 1, 1) + "]",
                  "69 points of the face, expected 68, 70, 468 or 478")}) {
    const std::string text = OpenPose(parts);
    EXPECT_THAT(FileErrorOf("clip.json", [&] { Load(text); }), HasSubstr(expected));
  }
}

TEST(HandAndFacePoints, OfWholeBodies) {
  for (const KeypointConvention* body : {&CocoWholeBody23(), &Halpe26()}) {
    const std::string all = StickNumbers(body->names, 600, 500, 400) + "," + Numbers(68, 500, 50) + "," +
                            Numbers(21, 300, 100) + "," + Numbers(21, 400, 200);
    ExpectParts(Load(R"([{"image_id":1,"category_id":1,"keypoints":[)" + all + R"(],"score":1}])"), 0.5F);
  }
  // COCO-WholeBody's annotations: flags in place of confidences.
  ExpectParts(Load(R"({"annotations":[{"image_id":1,"keypoints":[)" + Numbers(17, 600, 500, 1, 2) +
                   R"(],"lefthand_kpts":[)" + Numbers(21, 300, 100, 1, 1) + R"(],"righthand_kpts":[)" +
                   Numbers(21, 400, 200, 1, 1) + R"(],"face_kpts":[)" + Numbers(68, 500, 50, 1, 2) + "]}]}"),
              0.5F);
}

TEST(HandAndFacePoints, OfMediaPipe) {
  const auto list = [](int n, double x0, double y0, const char* more) {
    std::string text;
    for (int k = 0; k < n; ++k) {
      text += Concatenate(k > 0 ? "," : "", R"({"x":)", (x0 + k + 0.5) / 1000, R"(,"y":)", (y0 + 2 * k + 0.5) / 1000,
                          R"(,"z":0)", more, "}");
    }
    return "[" + text + "]";
  };
  for (const bool python : {true, false}) {
    const auto key = [&](const char* a, const char* b) { return Concatenate(R"(")", python ? a : b, R"(":)"); };
    const std::string frame =
        "[{" + key("pose_landmarks", "poseLandmarks") + list(33, 600, 400, R"(,"visibility":0.9)") + "," +
        key("left_hand_landmarks", "leftHandLandmarks") + list(21, 300, 100, R"(,"visibility":0)") + "," +
        key("right_hand_landmarks", "rightHandLandmarks") + list(21, 400, 200, "") + "," +
        key("face_landmarks", "faceLandmarks") + list(python ? 468 : 478, 500, 50, "") + "}]";
    ExpectParts(Load(frame, OfImage(1000)), 1, &Face68Of468());
  }
  const std::string without = "[{\"pose_landmarks\":" + list(33, 600, 400, "") + R"(,"left_hand_landmarks":null}])";
  EXPECT_TRUE(Load(without, OfImage(1000)).hands_and_face.empty());
}

TEST(HandAndFacePoints, UnsureOnesAreDropped) {
  const std::string text = OpenPose(R"(,"hand_left_keypoints_2d":[)" + Numbers(21, 300, 100) + "]");
  LoadDetectionsOptions options;
  options.min_confidence = 0.6;
  const PersonDetections person = Load(text, options);
  EXPECT_EQ(person.hands_and_face.frames[0]->hands[0]->points[3].confidence, 0);
}

PeopleSequence WithHands() {
  PeopleSequence people;
  people.convention = Coco17();
  people.timestamps = {0, 0.1};
  DetectedPerson plain, full;
  plain.points.assign(17, {10, 20, 0.5F});
  for (int k = 0; k < 17; ++k) full.points.push_back({200 + 10 * float(k), 100 + 20 * float(k), 1});
  HandsAndFace parts;
  HandObservation& hand = parts.hands[HandsAndFace::kRight].emplace();
  FaceObservation& face = parts.face.emplace();
  for (size_t k = 0; k < kHandPoints; ++k) {
    hand.points[k] = {float(k), 2, 0.75F};
    hand.sigma_px[k] = 1 + float(k);
    hand.metres[k] = Eigen::Vector3f(0.01F, float(k), 3);
  }
  for (size_t k = 0; k < kFacePoints; ++k) face.points[k] = {float(k), 3, 0.25F}, face.depth_px[k] = -float(k);
  hand.points[5] = {};
  face.sigma_px = 2;
  full.hands_and_face = std::make_shared<const HandsAndFace>(parts);
  people.frames = {{plain, full}, {full}};
  return people;
}

TEST(HandsInNpz, ComeBack) {
  const TemporaryFolder folder;
  const PeopleSequence people = WithHands();
  WritePeople(folder.File("p.npz"), people);
  const PeopleSequence read = PeopleFromNpz(ReadNpz(folder.File("p.npz")), "p.npz");
  EXPECT_EQ(read.frames[0][0].hands_and_face, nullptr);
  for (const DetectedPerson* person : {&read.frames[0][1], &read.frames[1][0]}) {
    const HandsAndFace& expected = *people.frames[1][0].hands_and_face;
    ASSERT_NE(person->hands_and_face, nullptr);
    const HandsAndFace& parts = *person->hands_and_face;
    EXPECT_FALSE(parts.hands[HandsAndFace::kLeft]);
    ASSERT_TRUE(parts.hands[HandsAndFace::kRight] && parts.face);
    EXPECT_EQ(parts.hands[1]->sigma_px, expected.hands[1]->sigma_px);
    EXPECT_EQ(parts.hands[1]->points[5].confidence, 0);
    EXPECT_EQ(parts.hands[1]->points[7].x, 7);
    EXPECT_EQ(parts.hands[1]->metres[7], expected.hands[1]->metres[7]);
    EXPECT_EQ(parts.face->depth_px, expected.face->depth_px);
    EXPECT_EQ(parts.face->points[9].confidence, 0.25F);
    EXPECT_EQ(parts.face->sigma_px, 2);
  }
  const PersonDetections one = LoadPersonDetections(folder.File("p.npz"));
  EXPECT_EQ(one.hands_and_face.frames[1]->face->points[9].x, 9);
}

TEST(HandsInNpz, FilesWithoutThemHaveNoKeysOfThem) {
  const TemporaryFolder folder;
  PeopleSequence people = WithHands();
  for (auto& frame : people.frames) {
    for (DetectedPerson& person : frame) person.hands_and_face = nullptr;
  }
  WritePeople(folder.File("p.npz"), people);
  EXPECT_EQ(ReadNpz(folder.File("p.npz")).size(), 7U);
}

TEST(HandsInNpz, WhatDoesNotFitIsRefused) {
  const TemporaryFolder folder;
  WritePeople(folder.File("p.npz"), WithHands());
  const NpzArrays good = ReadNpz(folder.File("p.npz"));
  const auto refusal = [&](const char* key, const NdArray& array) {
    NpzArrays bad = good;
    bad[key] = array;
    return FileErrorOf(key, [&] { PeopleFromNpz(bad, "p.npz"); });
  };
  const int32_t rows[] = {0, 3}, one[] = {1}, sides[] = {1, 2};
  EXPECT_THAT(refusal("hand_person", NdArray::FromInts32(rows, {2})), HasSubstr("entry 1 is 3, expected 0 to 2"));
  EXPECT_THAT(refusal("hand_side", NdArray::FromInts32(one, {1})),
              HasSubstr("1 entries, expected the 2 of hand_person"));
  EXPECT_THAT(refusal("hand_side", NdArray::FromInts32(sides, {2})), HasSubstr("entry 1 is 2, expected 0 to 1"));
  const std::vector<float> values(200, -1);
  EXPECT_THAT(refusal("hand_keypoints", NdArray::FromFloats(values.data(), {2, 20, 3})),
              HasSubstr("expected numbers, 2 x 21 x 3"));
  EXPECT_THAT(refusal("hand_sigma_px", NdArray::FromFloats(values.data(), {2, 21})),
              HasSubstr("entry 0 is -1, expected 0 or a positive number"));
  EXPECT_THAT(refusal("face_sigma_px", NdArray::FromFloats(values.data(), {2})), HasSubstr("entry 0 is -1"));
  EXPECT_THAT(refusal("face_depth_px", NdArray::FromFloats(values.data(), {2, 2})), HasSubstr("2 x 68"));
  for (const char* key : {"hand_side", "hand_metres", "face_keypoints"}) {
    NpzArrays bad = good;
    bad.erase(key);
    EXPECT_THAT(FileErrorOf("p.npz", [&] { PeopleFromNpz(bad, "p.npz"); }), HasSubstr(key));
  }
}

}  // namespace
}  // namespace bodyloom::hand_and_face_points_test
