// SPDX-License-Identifier: Apache-2.0
#include "data_tools/datasets/rich_truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "data_tools/formats/atomic_file.h"
#include "tests/data_tools/datasets/still_camera_files.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::rich_truth_test {
namespace {

using ::testing::HasSubstr;

/// Five frames of somebody.
Motion Somebody(double offset) {
  Motion motion;
  motion.poses.resize(5, 72);
  motion.trans.resize(5, 3);
  for (Eigen::Index i = 0; i < motion.poses.size(); ++i) motion.poses.data()[i] = 0.4 * std::sin(double(i) + offset);
  for (Eigen::Index i = 0; i < motion.trans.size(); ++i) motion.trans.data()[i] = std::cos(double(i) + offset);
  motion.betas = Eigen::VectorXd::LinSpaced(10, -1, 1).array() + offset;
  for (int t = 0; t < 5; ++t) motion.timestamps.push_back(t / 30.0);
  return motion;
}

class RichTruth : public ::testing::Test {
 protected:
  RichTruth() {
    // Frames 17 to 21; subject 005 is not there in frame 19.
    for (int t = 0; t < 5; ++t) {
      const std::string frame = Sequence() + "/000" + std::to_string(17 + t);
      std::filesystem::create_directories(frame);
      WriteFileAtomically(frame + "/004.pkl", RichPickle(first_, t));
      if (t != 2) WriteFileAtomically(frame + "/005.pkl", RichPickle(second_, t));
    }
    std::filesystem::create_directories(Sequence() + "/notes");
    std::filesystem::create_directories(Scene() + "/calibration");
    camera_.camera.distortion[0] = -0.1, camera_.camera.distortion[2] = 1e-3;
    WriteFileAtomically(Scene() + "/calibration/000.xml", RichXml(RoomCamera()));
    WriteFileAtomically(Scene() + "/calibration/003.xml", RichXml(camera_));
  }
  [[nodiscard]] std::string Sequence() const { return folder_.File("ParkingLot1_004_005_greetings"); }
  [[nodiscard]] std::string Scene() const { return folder_.File("ParkingLot1"); }

  const TemporaryFolder folder_;
  const Motion first_ = Somebody(0), second_ = Somebody(1);
  NamedCamera camera_ = RoomCamera(1024, 1030);
};

TEST_F(RichTruth, SubjectsInTheWorldOfTheirCamera) {
  EXPECT_TRUE(IsRichSequence(Sequence()));
  EXPECT_FALSE(IsRichSequence(Scene()));
  const VideoTruth a = ReadRichTruth(Sequence(), 0, camera_), b = ReadRichTruth(Sequence(), 1, camera_);
  EXPECT_EQ(a.dataset, "RICH");
  EXPECT_EQ(a.sequence, "ParkingLot1_004_005_greetings");
  EXPECT_EQ(a.subject, "004");
  EXPECT_EQ(b.subject, "005");
  EXPECT_EQ(a.num_people, 2);
  const Track& track = a.track;
  EXPECT_EQ(track.motion.body, "smplx");
  EXPECT_EQ(track.motion.poses, first_.poses.leftCols(66));
  EXPECT_EQ(track.motion.trans, first_.trans);
  EXPECT_LT((track.motion.betas - first_.betas).norm(), 1e-12);
  EXPECT_NEAR(track.motion.timestamps[4], 4 / 30.0, 1e-12) << "the first frame is at time 0";
  ASSERT_EQ(track.camera_from_scene.size(), 5U);
  EXPECT_EQ(track.camera_from_scene[3].camera_from_world_translation, camera_.pose.camera_from_world_translation);
  EXPECT_FALSE(b.track.HasResult(2));
  EXPECT_TRUE(b.track.HasResult(3));
  EXPECT_EQ(b.track.motion.trans.row(4), second_.trans.row(4));
  EXPECT_THAT(FileErrorOf(Sequence(), [&] { ReadRichTruth(Sequence(), 2, camera_); }),
              HasSubstr("2 people (004, 005), expected one with number 2"));
}

TEST_F(RichTruth, CamerasByTheirNumber) {
  for (const char* view : {"3", "003"}) {
    const NamedCamera read = ReadRichCamera(Scene(), view);
    EXPECT_EQ(read.name, "003");
    EXPECT_EQ(read.camera.width, 1024) << "twice the principal point";
    EXPECT_EQ(read.camera.height, 1030);
    EXPECT_TRUE(read.camera.K().isApprox(camera_.camera.K(), 1e-12));
    EXPECT_EQ(read.camera.distortion, camera_.camera.distortion);
    EXPECT_TRUE(read.pose.camera_from_world_rotation.isApprox(camera_.pose.camera_from_world_rotation, 1e-12));
    EXPECT_TRUE(read.pose.camera_from_world_translation.isApprox(camera_.pose.camera_from_world_translation, 1e-12));
  }
  EXPECT_EQ(ReadRichCamera(Scene() + "/calibration/000.xml", "").name, "000");
  EXPECT_THAT(FileErrorOf(Scene(), [&] { ReadRichCamera(Scene(), ""); }), HasSubstr("no view chosen; it has 000, 003"));
  EXPECT_THAT(FileErrorOf(Scene(), [&] { ReadRichCamera(Scene(), "4"); }), HasSubstr("no camera '4'"));
}

TEST_F(RichTruth, BrokenCamerasAreNamed) {
  const std::string good = RichXml(camera_);
  const auto error = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return FileErrorOf("c.xml", [&] { RichCameraFromXml(text, "c.xml"); });
  };
  EXPECT_THAT(error("<CameraMatrix", "<Camera"), HasSubstr("CameraMatrix: is not there"));
  EXPECT_THAT(error("1145", "abc"), HasSubstr("Intrinsics: found 'abc', expected a number"));
  EXPECT_THAT(error("1145", "-1145"), HasSubstr("Intrinsics: expected [fx 0 cx"));
  EXPECT_THAT(error("1145", "1145 3"), HasSubstr("Intrinsics: 10 numbers, expected 9"));
  EXPECT_THAT(error("<data>\n    0.9", "<data>\n    2.9"), HasSubstr("CameraMatrix: expected [R|t], R a rotation"));
  for (size_t size = 0; size + 40 < good.size(); size += 7) {
    FileErrorOf("c.xml", [&] { RichCameraFromXml(good.substr(0, size), "c.xml"); });
  }
}

TEST_F(RichTruth, BrokenBodiesAreNamed) {
  Motion odd = first_;
  odd.trans(0, 1) = NAN;
  const std::string path = Sequence() + "/00018/004.pkl";
  WriteFileAtomically(path, RichPickle(odd, 0));
  EXPECT_THAT(FileErrorOf(path, [&] { ReadRichTruth(Sequence(), 0, camera_); }),
              HasSubstr("transl: row 0 is not finite"));
  odd = first_;
  odd.betas.conservativeResize(8);
  WriteFileAtomically(path, RichPickle(odd, 0));
  EXPECT_THAT(FileErrorOf(path, [&] { ReadRichTruth(Sequence(), 0, camera_); }), HasSubstr("betas: 8, expected 10"));
  using namespace pickle_writer;  // NOLINT(google-build-using-namespace)
  WriteFileAtomically(path, Pickle(2, Dict({{Str2("betas"), Doubles2({1, 2}, {1, 2})}})));
  EXPECT_THAT(FileErrorOf(path, [&] { ReadRichTruth(Sequence(), 0, camera_); }), HasSubstr("global_orient"));
}

}  // namespace
}  // namespace bodyloom::rich_truth_test
