// SPDX-License-Identifier: Apache-2.0
#include "data_tools/datasets/video_truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/data_tools/datasets/video_truth_files.h"
#include "tests/data_tools/formats/expect_file_error.h"
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

}  // namespace
}  // namespace bodyloom::video_truth_test
