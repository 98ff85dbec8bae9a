// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/hands_and_face_detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "data_tools/video/video_reader.h"
#include "tests/support/paths.h"
#include "tests/tracking/detection/models_there.h"
#include "tracking/detection/people_detector.h"

namespace bodyloom::hands_and_face_detector_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// Some frames of a dancing man, and his poses.
class HandsAndFaceDetectorTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const fs::path video = fs::path(SharedDir()) / "data" / "vid2densepose" / "input_video.mp4";
    if (!fs::exists(video)) GTEST_SKIP() << video << " is not there";
    if (!HandModelsAreThere()) GTEST_SKIP() << "no networks; ./dev models fetches them";
    VideoReader reader(video.string());
    PeopleDetectorOptions options;
    options.network = PoseNetworkSize::kFull;
    options.max_people = 1;
    PeopleDetector people("", options);
    Image frame;
    for (int t = 0; t < 12 && reader.Read(&frame); ++t) {
      frames_.push_back(frame);
      poses_.push_back(people.Detect({&frame, 1}).front());
      ASSERT_EQ(poses_.back().size(), 1U);
    }
  }

  std::vector<Image> frames_;
  std::vector<std::vector<DetectedPose>> poses_;
};

TEST_F(HandsAndFaceDetectorTest, FindsThemAtTheBody) {
  HandsAndFaceDetector detector("", {});
  const auto found = detector.Detect(frames_, poses_);
  const HandsAndFaceSummary& summary = detector.summary();
  EXPECT_EQ(summary.hands.parts, 24);
  EXPECT_GE(summary.hands.found, 12);
  EXPECT_EQ(summary.faces.parts, 12);
  EXPECT_GE(summary.faces.found, 11);
  for (const PartCounts& n : {summary.hands, summary.faces}) {
    EXPECT_EQ(n.found + n.hidden + n.small + n.absent + n.elsewhere, n.parts);
  }
  ASSERT_EQ(found.size(), frames_.size());
  int hands = 0;
  for (size_t t = 0; t < found.size(); ++t) {
    ASSERT_EQ(found[t].size(), 1U);
    if (!found[t][0]) continue;
    const auto& body = poses_[t][0].landmarks;
    for (size_t side = 0; side < 2; ++side) {
      const auto& hand = found[t][0]->hands[side];
      if (!hand) continue;
      ++hands;
      const Eigen::Vector2d wrist(hand->points[0].x, hand->points[0].y);
      EXPECT_LT((wrist - body[15 + side].pixel).norm(), 60) << "frame " << t;
      EXPECT_GT(hand->sigma_px[4], hand->sigma_px[1]);
      EXPECT_TRUE(hand->metres[8].allFinite());
    }
    if (const auto& face = found[t][0]->face) {
      // Between the eyes' corners, and the nose's tip, as the body has them.
      const Eigen::Vector2d right((face->points[36].x + face->points[39].x) / 2,
                                  (face->points[36].y + face->points[39].y) / 2),
          nose(face->points[30].x, face->points[30].y);
      EXPECT_LT((right - body[5].pixel).norm(), 8) << "frame " << t;
      EXPECT_LT((nose - body[0].pixel).norm(), 12) << "frame " << t;
    }
  }
  EXPECT_EQ(hands, summary.hands.found);
}

TEST_F(HandsAndFaceDetectorTest, ThreadsChangeNothing) {
  HandsAndFaceDetector one("", {.num_threads = 1}), three("", {.num_threads = 3});
  const auto expected = one.Detect(frames_, poses_), found = three.Detect(frames_, poses_);
  for (size_t t = 0; t < expected.size(); ++t) {
    ASSERT_EQ(expected[t][0] == nullptr, found[t][0] == nullptr);
    if (!expected[t][0]) continue;
    for (size_t side = 0; side < 2; ++side) {
      const auto &a = expected[t][0]->hands[side], &b = found[t][0]->hands[side];
      ASSERT_EQ(a.has_value(), b.has_value());
      for (size_t k = 0; a && k < kHandPoints; ++k) EXPECT_EQ(a->points[k].x, b->points[k].x);
    }
  }
}

TEST_F(HandsAndFaceDetectorTest, LeftOutAreCountedAndNamed) {
  HandsAndFaceDetector large("", {.min_side_px = 1e6});
  EXPECT_EQ(large.Detect(frames_, poses_)[0][0], nullptr);
  EXPECT_EQ(large.summary().hands.small, 24);
  EXPECT_EQ(large.summary().faces.small, 12);
  std::vector<std::vector<DetectedPose>> changed = poses_;
  for (std::vector<DetectedPose>& people : changed) {
    people[0].landmarks[15].visibility = 0.05;  // the left wrist is hidden
    for (int k : {16, 18, 20}) people[0].landmarks[size_t(k)].pixel += Eigen::Vector2d(2000, 0);  // black
    for (size_t k = 0; k < 11; ++k) people[0].landmarks[k].pixel += Eigen::Vector2d(0, -3000);
  }
  HandsAndFaceDetector detector("", {});
  const auto found = detector.Detect(frames_, changed);
  EXPECT_EQ(detector.summary().hands.hidden, 12);
  EXPECT_EQ(detector.summary().hands.found, 0);
  EXPECT_EQ(detector.summary().faces.absent, 12);
  EXPECT_EQ(found[3][0], nullptr);
  EXPECT_THAT(ToText(detector.summary()), HasSubstr("hands    0 of 24 found; 12 hidden"));
  EXPECT_THAT(ToText(detector.summary()), HasSubstr("faces    0 of 12 found; 12 not seen by the network"));
}

/// Both wrists at one hand: it is that of the wrist which lies nearer to its own.
TEST_F(HandsAndFaceDetectorTest, OneHandIsNotTwo) {
  HandsAndFaceDetector alone("", {}), both("", {});
  std::vector<std::vector<DetectedPose>> changed = poses_;
  for (std::vector<DetectedPose>& people : changed) {
    for (int k : {15, 17, 19}) {
      people[0].landmarks[size_t(k)] = people[0].landmarks[size_t(k) + 1];
      people[0].landmarks[size_t(k)].pixel += Eigen::Vector2d(3, 3);
    }
  }
  const auto expected = alone.Detect(frames_, poses_), found = both.Detect(frames_, changed);
  EXPECT_GT(both.summary().hands.elsewhere, 0);
  for (size_t t = 0; t < found.size(); ++t) {
    if (found[t][0]) {
      EXPECT_FALSE(found[t][0]->hands[0] && found[t][0]->hands[1]) << "frame " << t;
    }
  }
}

TEST(HandsAndFaceSummary, Text) {
  HandsAndFaceSummary summary;
  EXPECT_EQ(ToText(summary), "");
  summary.why_not = "hand_recrop.tflite: not in x";
  EXPECT_EQ(ToText(summary), "hands    not looked for: hand_recrop.tflite: not in x\n");
}

TEST(HandsAndFaceChoice, Names) {
  for (const char* name : {"off", "auto", "on"}) EXPECT_EQ(ToText(HandsAndFaceChoiceNamed(name)), name);
  EXPECT_THROW(HandsAndFaceChoiceNamed("yes"), std::invalid_argument);
}

TEST(HandsAndFaceDetector, NamesAMissingNetwork) {
  EXPECT_THROW(HandsAndFaceDetector("/nowhere", {}), std::runtime_error);
}

}  // namespace
}  // namespace bodyloom::hands_and_face_detector_test
