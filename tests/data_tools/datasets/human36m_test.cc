// SPDX-License-Identifier: Apache-2.0
#include "data_tools/datasets/human36m.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/data_tools/datasets/still_camera_files.h"
#include "tests/data_tools/formats/expect_file_error.h"

namespace bodyloom::human36m_test {
namespace {

using ::testing::HasSubstr;

std::vector<MatrixX3d> Joints(int frames) {
  std::vector<MatrixX3d> joints;
  for (int t = 0; t < frames; ++t) {
    joints.emplace_back(17, 3);
    for (int i = 0; i < 51; ++i) joints.back().data()[i] = std::sin(i + 0.3 * t);
  }
  return joints;
}

template <typename Read>
auto OfJson(const std::string& text, const Read& read) {
  const nlohmann::json json = ParseJson(text, "h.json");
  return read(JsonNode(json, "h.json"));
}

Human36mClip ClipOf(const std::string& text, const std::string& sequence) {
  return OfJson(text, [&](const JsonNode& document) { return Human36mFromJson(document, sequence); });
}
std::string ErrorOf(const std::string& text, const std::string& sequence = "2/1") {
  return FileErrorOf("h.json", [&] { ClipOf(text, sequence); });
}

TEST(Human36m, JointsOfJson) {
  std::vector<MatrixX3d> joints = Joints(4);
  joints[2].resize(0, 3);
  for (const char* name : {"2/1", "Directions/1"}) {
    const Human36mClip clip = ClipOf(Human36mJointsJson(joints), name);
    ASSERT_EQ(clip.joints.size(), 4U);
    EXPECT_EQ(clip.joints[2].rows(), 0);
    for (const size_t t : {0U, 1U, 3U}) {
      EXPECT_LT((clip.joints[t] - joints[t]).cwiseAbs().maxCoeff(), 1e-12);
    }
  }
  EXPECT_THAT(ErrorOf(Human36mJointsJson(joints), "3/1"), HasSubstr("no sequence '3/1'; the file has 2/1"));
  EXPECT_THAT(ErrorOf(Human36mJointsJson(joints), ""), HasSubstr("no sequence ''"));
  EXPECT_THAT(ErrorOf("[1]"), HasSubstr("no sequence"));
  EXPECT_THAT(ErrorOf(R"({"2":{"1":{"a":[]}}})"), HasSubstr("frame 'a', expected a number from 0"));
  EXPECT_THAT(ErrorOf(R"({"2":{"1":{}}})"), HasSubstr("no frame"));
  EXPECT_THAT(ErrorOf(R"({"2":{"1":{"0":[[1,2,3]]}}})"), HasSubstr("h.json: 2.1.0"));
  joints[0](3, 1) = 1e6;
  EXPECT_THAT(ErrorOf(Human36mJointsJson(joints)), HasSubstr("farther than 100 m"));
}

TEST(Human36m, SeventeenOfThirtyTwoPositions) {
  const std::vector<MatrixX3d> joints = Joints(3);
  const PicklePtr file = ReadPickle(pickle_writer::Pickle(2, Human36mPositions(joints)), "d.npz");
  const Human36mClip clip = Human36mFromPositions(*file, "S9/Directions 1", "d.npz");
  ASSERT_EQ(clip.joints.size(), 3U);
  for (size_t t = 0; t < 3; ++t) EXPECT_EQ(clip.joints[t], joints[t]);
  EXPECT_THAT(FileErrorOf("d.npz", [&] { Human36mFromPositions(*file, "S9/Walking", "d.npz"); }),
              HasSubstr("no sequence 'S9/Walking'; the file has S9/Directions 1"));
  EXPECT_TRUE(IsHuman36mPositions(ReadNpzBytes(Human36mPositionsNpz(joints), "d.npz")));
  using namespace pickle_writer;  // NOLINT(google-build-using-namespace)
  const PicklePtr flat =
      ReadPickle(Pickle(2, Dict({{Str2("S9"), Dict({{Str2("a"), Doubles2({1, 2, 3}, {1, 1, 3})}})}})), "d.npz");
  EXPECT_THAT(FileErrorOf("d.npz", [&] { Human36mFromPositions(*flat, "S9/a", "d.npz"); }),
              HasSubstr("1x1x3, expected frames x 32 x 3"));
}

TEST(Human36m, SmplFitsOfEveryFifthFrame) {
  Motion motion;
  motion.poses = RowMatrixXd::Random(11, 72);
  motion.trans = MatrixX3d::Random(11, 3);
  motion.betas = Eigen::VectorXd::LinSpaced(10, -1, 1);
  for (int t = 0; t < 11; ++t) motion.timestamps.push_back(t / 50.0);
  const std::string text = Human36mSmplJson(motion, 5);
  const NamedCamera camera = RoomCamera();
  EXPECT_TRUE(OfJson(text, [](const JsonNode& document) { return HasHuman36mSmpl(document); }));
  EXPECT_FALSE(
      OfJson(Human36mJointsJson(Joints(1)), [](const JsonNode& document) { return HasHuman36mSmpl(document); }));
  const VideoTruth truth =
      OfJson(text, [&](const JsonNode& document) { return Human36mSmplFromJson(document, "2/1", camera); });
  EXPECT_EQ(truth.fps, 50);
  EXPECT_EQ(truth.track.num_frames(), 15) << "the video goes on after the last fit";
  EXPECT_NEAR(truth.track.motion.timestamps[10], 0.2, 1e-12);
  for (int t = 0; t < 15; ++t) EXPECT_EQ(truth.track.HasResult(t), t % 5 == 0);
  EXPECT_EQ(truth.track.motion.poses.row(5), motion.poses.row(5));
  EXPECT_EQ(truth.track.motion.trans.row(10), motion.trans.row(10));
  EXPECT_LT((truth.track.motion.betas - motion.betas).norm(), 1e-12);
  EXPECT_EQ(truth.track.camera_from_scene[4].camera_from_world_translation, camera.pose.camera_from_world_translation);
}

}  // namespace
}  // namespace bodyloom::human36m_test
