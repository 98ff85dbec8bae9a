// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <filesystem>
#include <nlohmann/json.hpp>

#include <cmath>

#include "data_tools/datasets/video_truth.h"

#include "data_tools/formats/atomic_file.h"
#include "tests/data_tools/datasets/still_camera_files.h"
#include "tests/data_tools/datasets/video_truth_files.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/short_track.h"

namespace bodyloom::video_truth_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Track Moving() {
  Track track = ShortTrack(6, SynthCameraMotion::kWalking);
  track.motion.betas = Eigen::VectorXd::LinSpaced(10, -1, 1);
  return track;
}

std::vector<uint8_t> AllGood(const Track& track) { return std::vector<uint8_t>(size_t(track.num_frames()), 1); }

VideoTruth Read(const std::string& bytes, int person = 0) {
  return VideoTruthFromPickle(*ReadPickle(bytes, "t.pkl"), person, "t.pkl");
}

void ExpectMotionOf(const Track& expected, const Track& read) {
  EXPECT_EQ(read.motion.body, "smpl");
  EXPECT_EQ(read.motion.poses, expected.motion.poses);
  EXPECT_EQ(read.motion.trans, expected.motion.trans);
  EXPECT_EQ(read.motion.betas, expected.motion.betas);
  EXPECT_EQ(read.camera.fx, expected.camera.fx);
  ASSERT_EQ(read.camera_from_scene.size(), expected.camera_from_scene.size());
  EXPECT_EQ(read.camera_from_scene.back().camera_from_world_rotation,
            expected.camera_from_scene.back().camera_from_world_rotation);
  EXPECT_EQ(read.camera_from_scene.back().camera_from_world_translation,
            expected.camera_from_scene.back().camera_from_world_translation);
  EXPECT_NEAR(read.motion.timestamps[5], 5 / 30.0, 1e-12);
}

TEST(VideoTruth, Emdb) {
  const Track track = Moving();
  std::vector<uint8_t> good = AllGood(track);
  const VideoTruth all = Read(EmdbPickle(track, good, "female"));
  EXPECT_EQ(all.dataset, "EMDB");
  EXPECT_EQ(all.protocol, "emdb");
  EXPECT_EQ(all.sequence, "P0_00_walk");
  EXPECT_EQ(all.gender, "female");
  EXPECT_EQ(all.track.camera.width, 320);
  EXPECT_EQ(all.track.camera.height, 240);
  ExpectMotionOf(track, all.track);
  good[3] = 0;
  const VideoTruth some = Read(EmdbPickle(track, good, "neutral"));
  EXPECT_EQ(some.track.frame_status[3], FrameStatus::kLost);
  EXPECT_FALSE(some.track.HasResult(3));
  EXPECT_TRUE(some.track.HasResult(2));
}

TEST(VideoTruth, PeopleOfThreeDpw) {
  const Track first = Moving();
  Track second = first;
  second.motion.trans.array() += 1;
  std::vector<uint8_t> valid = AllGood(first);
  valid[0] = 0;
  const std::string bytes = ThreeDpwPickle({first, second}, {AllGood(first), valid});
  const VideoTruth a = Read(bytes, 0), b = Read(bytes, 1);
  EXPECT_EQ(a.dataset, "3DPW");
  EXPECT_EQ(a.protocol, "3dpw");
  EXPECT_EQ(a.num_people, 2);
  EXPECT_EQ(a.gender, "male");
  EXPECT_EQ(b.gender, "female");
  EXPECT_EQ(a.track.camera.width, int(std::lround(2 * first.camera.cx)));
  ExpectMotionOf(first, a.track);
  EXPECT_FALSE(b.track.HasResult(0));
  EXPECT_EQ(b.track.motion.trans.row(4), second.motion.trans.row(4));
  EXPECT_THAT(FileErrorOf("t.pkl", [&] { Read(bytes, 2); }), HasSubstr("2 people, expected one with number 2"));
}

TEST(VideoTruth, FramesAtTheTracksTimes) {
  EXPECT_THAT(FramesNearTimes(12, 30, {2 / 30.0, 3.2 / 30, 6.9 / 30}, "t.pkl"), ElementsAre(2, 3, 7));
  EXPECT_THAT(FramesNearTimes(12, 50, {0.1}, "t.pkl"), ElementsAre(5));
  for (const double time : {-0.1, 9.0, double(NAN)}) {
    EXPECT_THAT(FileErrorOf("t.pkl", [&] { FramesNearTimes(12, 30, {time}, "t.pkl"); }), HasSubstr("12 frames at 30"));
  }
}

TEST(VideoTruth, BrokenFilesAreNamed) {
  using namespace pickle_writer;  // NOLINT(google-build-using-namespace)
  const auto error = [](const std::string& bytes) { return FileErrorOf("t.pkl", [&] { Read(bytes); }); };
  EXPECT_THAT(error(Pickle(2, Dict({{Str2("smpl_poses"), Int(1)}}))), HasSubstr("expected EMDB's"));
  Track track = Moving();
  std::vector<uint8_t> good = AllGood(track);
  good.pop_back();
  EXPECT_THAT(error(EmdbPickle(track, good, "male")), HasSubstr("good_frames_mask: 11, expected 12"));
  track.motion.trans(2, 1) = NAN;
  EXPECT_THAT(error(EmdbPickle(track, AllGood(track), "male")), HasSubstr("trans: row 2 is not finite"));
  track = Moving();
  track.camera.fx = -1;
  EXPECT_THAT(error(EmdbPickle(track, AllGood(track), "male")), HasSubstr("intrinsics: expected"));
  track = Moving();
  track.camera_from_scene[4].camera_from_world_rotation *= 2;
  EXPECT_FALSE(Read(EmdbPickle(track, AllGood(track), "male")).track.HasResult(4))
      << "a camera that is no rigid motion";
}

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

}  // namespace bodyloom::video_truth_test
