// SPDX-License-Identifier: Apache-2.0
/// Tracking of everybody in two real videos. Skipped where the recordings or the networks (./dev models) are missing.
#include "pipelines/track/track_people_in_videos.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/rig_io.h"
#include "data_tools/video/video_reader.h"
#include "geometry/base/check.h"
#include "tests/support/paths.h"
#include "tests/support/real_video.h"
#include "tests/support/scratch_folder.h"
#include "tests/tracking/detection/models_there.h"

namespace bodyloom::track_people_in_videos_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TrackPeopleInVideosRequest Request(const ScratchFolder& folder) {
  TrackPeopleInVideosRequest request;
  request.videos = {"left.mp4", "right.mp4"};
  request.out = folder / "out";
  return request;
}

TEST(TrackPeopleInVideos, RefusesContradictionsInOneLine) {
  const ScratchFolder folder;
  const auto refuses = [&](const TrackPeopleInVideosRequest& request, const std::string& why) {
    EXPECT_THAT([&] { TrackPeopleInVideos(request); }, ThrowsMessage<RequestError>(HasSubstr(why)));
  };
  TrackPeopleInVideosRequest request = Request(folder);
  request.videos = {"left.mp4", "left.mp4"};
  refuses(request, "left.mp4 is given twice");
  request = Request(folder);
  request.views = {"a"};
  refuses(request, "2 videos and 1 names in --view");
  request.views = {"a", "a"};
  refuses(request, "--view lists a twice");
  request.views = {"a", "b/c"};
  refuses(request, "expected a name without '/'");
  request = Request(folder);
  request.masks = true;
  refuses(request, "leave out --masks");
  request = Request(folder);
  request.track.camera_path = "path.json";
  refuses(request, "leave out --camera-path");
  request = Request(folder);
  request.known = KnownOfRig::kPoses;
  refuses(request, "give --cameras FILE");
  request = Request(folder);
  request.videos.pop_back();
  refuses(request, "one video, expected several");
  EXPECT_THROW(TrackPeopleInVideos(Request(folder)), std::runtime_error) << "there are no such videos";
  EXPECT_FALSE(std::filesystem::exists(folder / "out/summary.json"));
}

TEST(TrackPeopleInVideos, OneVideoHasOneName) {
  TrackPeopleInVideosRequest request;
  request.videos = {"left.mp4"};
  request.views = {"c01"};
  EXPECT_FALSE(HasSeveralVideos(request));
  EXPECT_EQ(RequestOfOneVideo(request).track.video, "left.mp4");
  EXPECT_EQ(RequestOfOneVideo(request).track.view, "c01");
  request.views.emplace_back("c02");
  EXPECT_THROW(RequestOfOneVideo(request), RequestError);
}

class TrackPeopleInRealVideos : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const std::string& video : videos_) {
      if (const std::string why = WhyNoDetection(video); !why.empty()) GTEST_SKIP() << why;
    }
  }
  const std::vector<std::string> videos_ = {SharedDir() + "/data/pose2sim/two_people/cam01.mp4",
                                            SharedDir() + "/data/pose2sim/two_people/cam02.mp4"};
  const ScratchFolder folder_;
};

TEST_F(TrackPeopleInRealVideos, MatchesBothPeopleAndWritesARigAnOverlayAViewAndAPage) {
  TrackPeopleInVideosRequest request = Request(folder_);
  request.videos = videos_;
  request.track.from_s = 0.2;
  request.track.to_s = 1.4;
  request.track.detector.blazepose.network = PoseNetworkSize::kFull;
  request.report = true;
  const TrackPeopleReport report = TrackPeopleInVideos(request);
  ASSERT_EQ(report.people.size(), 2U);
  for (const TrackedPerson& person : report.people) {
    EXPECT_THAT(person.views, ElementsAre("cam01", "cam02"));
    EXPECT_NEAR(ReadTrack(person.track).motion.timestamps[0], 0.2, 0.02) << "the first video's time";
  }
  if (HandModelsAreThere()) {
    for (const TrackedPerson& person : report.people) {
      ASSERT_EQ(person.solve.hands.size(), 2U);
      EXPECT_EQ(ReadTrack(person.track).motion.body, BuiltinBodyWithHands().name());
      EXPECT_TRUE(person.solve.hands[0].ran || person.solve.hands[1].ran);
    }
    EXPECT_THAT(ToText(report), HasSubstr("hand cam02: seen in"));
  }
  const std::vector<RigCamera> rig = ReadRig(request.out + "/rig.json");
  ASSERT_EQ(rig.size(), 2U);
  EXPECT_NEAR(rig[1].offset_s, 0, 0.5 / 60) << "the cameras are synchronous";
  EXPECT_EQ(rig[0].camera.fx, ReadTrack(report.people[0].track).camera.fx);
  for (const char* name : {"cam01", "cam02"}) {
    EXPECT_TRUE(std::filesystem::exists(request.out + "/detections_" + name + ".npz"));
    const VideoReader overlay(request.out + "/overlay_" + name + ".mp4");
    EXPECT_EQ(overlay.info().width, 1088);
    EXPECT_EQ(overlay.info().num_frames, report.num_frames) << "in step with the first";
  }
  EXPECT_THAT(ReadFileBytes(request.out + "/report.html"), HasSubstr("picture-1"));
  const auto json = nlohmann::json::parse(ReadFileBytes(request.out + "/summary.json"));
  ASSERT_EQ(json["views"].size(), 2U);
  EXPECT_EQ(json["views"][1]["video"], videos_[1]);
  EXPECT_EQ(json["people"][1]["views"], nlohmann::json({"cam01", "cam02"}));
  EXPECT_THAT(ToText(report), HasSubstr("seen by cam01, cam02"));
}

}  // namespace
}  // namespace bodyloom::track_people_in_videos_test
