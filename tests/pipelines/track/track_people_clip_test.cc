// SPDX-License-Identifier: Apache-2.0
/// Tracking of everybody in a real video. Skipped where the recordings or the networks (./dev models) are missing.
#include "pipelines/track/track_people_clip.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/load_detections.h"
#include "data_tools/observations/part_labels.h"
#include "data_tools/video/video_reader.h"
#include "data_tools/video/video_writer.h"
#include "geometry/base/check.h"
#include "tests/support/paths.h"
#include "tests/support/real_video.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_files.h"
#include "tests/tracking/detection/models_there.h"

namespace bodyloom::track_people_clip_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class TrackPeopleClipOnRealVideo : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string why = WhyNoDetection(video_); !why.empty()) GTEST_SKIP() << why;
  }

  /// Two people, a few frames from the middle of the clip.
  [[nodiscard]] TrackPeopleClipRequest TwoPeople() const {
    TrackPeopleClipRequest request;
    request.track.video = video_;
    request.track.from_s = 0.5;
    request.track.to_s = 0.7;
    request.track.detector.blazepose.network = PoseNetworkSize::kFull;
    request.min_seconds = 0.1;
    request.out = folder_ / "out";
    return request;
  }

  const std::string video_ = SharedDir() + "/data/pose2sim/two_people/cam01.mp4";
  const ScratchFolder folder_;
};

TEST_F(TrackPeopleClipOnRealVideo, GivesEverybodyATrackInOneSpaceAndOneImage) {
  const TrackPeopleClipRequest request = TwoPeople();
  const TrackPeopleReport report = TrackPeopleClip(request);
  EXPECT_EQ(report.num_frames, 13);
  ASSERT_EQ(report.people.size(), 2U);
  const Track first = ReadTrack(request.out + "/person_0.npz"), second = ReadTrack(request.out + "/person_1.npz");
  EXPECT_EQ(first.camera.fx, second.camera.fx) << "one camera";
  EXPECT_EQ(first.camera.fx, report.scene.focal_px);
  for (int i = 0; i < 2; ++i) {
    const Track& track = i == 0 ? first : second;
    ASSERT_EQ(track.num_frames(), 13);
    EXPECT_NEAR(track.motion.timestamps[0], 0.5, 0.01) << "the video's time";
    // The body's landmarks lie on those that the detector saw of this person: the other one stands half a height away.
    LoadDetectionsOptions options;
    options.person = i;
    const KeypointSequence seen = LoadDetections(request.out + "/detections.npz", options);
    std::vector<double> errors;
    for (int t = 0; t < 13; ++t) {
      for (size_t k = 5; k < 17; ++k) {
        const auto it = std::find(seen.names.begin(), seen.names.end(), CocoNames()[k]);
        const Keypoint& p = seen.at(t, int(it - seen.names.begin()));
        Eigen::Vector2d pixel;
        ASSERT_TRUE(track.CameraAt(t).Project(track.coco17[size_t(t)].row(Eigen::Index(k)).transpose(), &pixel));
        errors.push_back((pixel - Eigen::Vector2d(p.x, p.y)).norm());
      }
    }
    std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
    EXPECT_LT(errors[errors.size() / 2], 0.04 * report.people[size_t(i)].seen.height_px) << "person " << i;
  }
  // They stand apart by more than a body's width.
  EXPECT_GT((first.joints[6].row(0) - second.joints[6].row(0)).norm(), 0.4);
  VideoReader overlay(request.out + "/overlay.mp4");
  EXPECT_EQ(overlay.info().width, report.width);
  EXPECT_EQ(overlay.info().num_frames, 13);
  const nlohmann::json json = nlohmann::json::parse(FileBytes(request.out + "/summary.json"));
  EXPECT_EQ(json["people"].size(), 2U);
  EXPECT_EQ(json["people"][1]["track"], request.out + "/person_1.npz");
  EXPECT_THAT(ToText(report), HasSubstr("person 1 13 frames"));
}

TEST_F(TrackPeopleClipOnRealVideo, ThoseAskedForAlone) {
  TrackPeopleClipRequest request = TwoPeople();
  request.track.to_s = 0.6;
  request.person = 1;
  request.overlay = false;
  request.masks = true;
  request.track.stature_m = 1.4;
  const TrackPeopleReport report = TrackPeopleClip(request);
  ASSERT_EQ(report.people.size(), 1U);
  EXPECT_EQ(report.people[0].solve.stature_m, 1.4);
  EXPECT_THAT(ToText(report), HasSubstr("1.40 m tall"));
  EXPECT_EQ(report.people[0].number, 1);
  EXPECT_EQ(report.num_found, 2);
  EXPECT_TRUE(std::filesystem::exists(request.out + "/person_1.npz"));
  EXPECT_FALSE(std::filesystem::exists(request.out + "/person_0.npz"));
  EXPECT_FALSE(std::filesystem::exists(request.out + "/mask_0.npz"));
  const PartLabelSequence mask = ReadPartLabels(request.out + "/mask_1.npz");
  ASSERT_EQ(mask.num_frames(), report.num_frames);
  EXPECT_EQ(mask.image_width, report.width);
  const LabelImage seen = mask.frames[0].Unpacked();
  EXPECT_GT(std::count(seen.labels.begin(), seen.labels.end(), 1), 10000);
  EXPECT_FALSE(std::filesystem::exists(request.out + "/overlay.mp4"));
  request.person = 7;
  EXPECT_THAT([&] { TrackPeopleClip(request); }, ThrowsMessage<std::runtime_error>(HasSubstr("7")));
}

TEST_F(TrackPeopleClipOnRealVideo, MasksAreCutWhereTheCameraStandsStillAndTracksAreTheSame) {
  TrackPeopleClipRequest request = TwoPeople();
  request.track.to_s = 0.75;
  request.person = 1;
  request.overlay = false, request.masks = true;
  const TrackPeopleReport report = TrackPeopleClip(request);
  EXPECT_GE(report.num_frames, 12);
  EXPECT_EQ(report.masks_cut, true);
  EXPECT_THAT(ToText(report), HasSubstr("masks    cut"));
  const std::string track = FileBytes(request.out + "/person_1.npz"), cut = FileBytes(request.out + "/mask_1.npz");
  request.coarse_masks = true;
  EXPECT_EQ(TrackPeopleClip(request).masks_cut, false);
  EXPECT_EQ(nlohmann::json::parse(FileBytes(request.out + "/summary.json"))["masks_cut"], false);
  EXPECT_TRUE(FileBytes(request.out + "/person_1.npz") == track);
  EXPECT_FALSE(FileBytes(request.out + "/mask_1.npz") == cut);
}

/// A woman who squats, whose hands are large, and the same made four times smaller.
class HandsOnRealVideo : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string why = WhyNoDetection(video_); !why.empty()) GTEST_SKIP() << why;
    if (!HandModelsAreThere()) GTEST_SKIP() << "no networks of hands; ./dev models fetches them";
  }

  [[nodiscard]] TrackPeopleClipRequest Squats() const {
    TrackPeopleClipRequest request;
    request.track.video = video_;
    request.track.to_s = 0.7;
    request.track.detector.blazepose.network = PoseNetworkSize::kFull;
    request.overlay = false;
    request.out = folder_ / "out";
    return request;
  }
  /// Tracks as the request says, and with --hands off.
  void RunBoth(TrackPeopleClipRequest request) {
    report_ = TrackPeopleClip(request);
    bytes_ = FileBytes(request.out + "/person_0.npz");
    track_ = ReadTrack(request.out + "/person_0.npz");
    request.track.detector.hands_and_faces = HandsAndFaceChoice::kOff;
    TrackPeopleClip(request);
    bytes_without_ = FileBytes(request.out + "/person_0.npz");
    without_ = ReadTrack(request.out + "/person_0.npz");
  }

  const std::string video_ = SharedDir() + "/data/tfjs_pose/pose_squats.mp4";
  const ScratchFolder folder_;
  TrackPeopleReport report_;
  Track track_, without_;
  std::string bytes_, bytes_without_;
};

TEST_F(HandsOnRealVideo, BendFingersAndTurnForearmsAndHeadAndNothingElse) {
  RunBoth(Squats());
  const BodyModel& body = BuiltinBodyWithHands();
  ASSERT_EQ(track_.motion.body, body.name());
  ASSERT_EQ(without_.motion.body, BuiltinBody().name());
  const TrackSequenceSummary& solve = report_.people[0].solve;
  ASSERT_EQ(solve.hands.size(), 2U);
  EXPECT_TRUE(solve.hands[0].ran && solve.hands[1].ran && solve.head->ran);
  EXPECT_GT(solve.hands[0].frames_seen, 3);
  EXPECT_THAT(ToText(report_), HasSubstr("left hand seen in"));
  EXPECT_TRUE(std::any_of(solve.plan.begin(), solve.plan.end(),
                          [](const PlanEntry& entry) { return entry.what == "hands" && entry.runs; }));

  const std::set<std::string> turned = {"head", "l_elbow", "r_elbow", "l_wrist", "r_wrist"};
  for (int j = 0; j < 22; ++j) {
    const bool same = track_.motion.poses.middleCols<3>(3 * j) == without_.motion.poses.middleCols<3>(3 * j);
    EXPECT_EQ(same, turned.count(SmplJointNames()[size_t(j)]) == 0) << SmplJointNames()[size_t(j)];
  }
  EXPECT_EQ(track_.motion.trans, without_.motion.trans);
  EXPECT_EQ(track_.motion.betas, without_.motion.betas);
  EXPECT_EQ(track_.camera.fx, without_.camera.fx);
  EXPECT_EQ(track_.joint_sigma.leftCols(22), without_.joint_sigma.leftCols(22));
  for (int t = 0; t < track_.num_frames(); ++t) {
    EXPECT_EQ(track_.joints[size_t(t)].topRows(22), without_.joints[size_t(t)].topRows(22));
    for (const int k : {5, 6, 11, 12, 13, 14, 15, 16}) {  // shoulders, hips and below
      EXPECT_EQ(track_.coco17[size_t(t)].row(k), without_.coco17[size_t(t)].row(k)) << k;
    }
  }
}

TEST_F(HandsOnRealVideo, WithoutLargeOnesTheTrackIsAsWithoutLookingForThem) {
  TrackPeopleClipRequest request = Squats();
  const std::string small = folder_ / "small.mp4";
  VideoReader reader(video_);
  const int width = reader.info().width / 4, height = reader.info().height / 4;
  VideoWriter writer(small, width, height, reader.info().fps);
  for (Image frame, quarter(width, height); writer.num_frames() < 12 && reader.Read(&frame);) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) std::copy_n(frame.pixel(4 * x, 4 * y), 3, quarter.pixel(x, y));
    }
    writer.Write(quarter);
  }
  writer.Finish();
  request.track.video = small;
  RunBoth(request);
  EXPECT_GT(report_.hands_and_faces.hands.parts, 0) << "they were looked for";
  EXPECT_EQ(report_.hands_and_faces.hands.found, 0);
  EXPECT_EQ(track_.motion.body, BuiltinBody().name());
  EXPECT_TRUE(bytes_ == bytes_without_);
}

TEST_F(HandsOnRealVideo, ABodyWithoutFingersIsNotLookedAtForThem) {
  TrackPeopleRequest request = Squats();
  request.track.to_s = 0.3;
  GivenInMemory given;
  given.body = BodyOrBuiltin("");
  const TrackedPeople found = TrackPeopleToMemory(request, {}, given);
  EXPECT_EQ(found.report.hands_and_faces.hands.parts, 0);
  EXPECT_EQ(found.people[0].track.motion.body, BuiltinBody().name());
  request.track.detector.hands_and_faces = HandsAndFaceChoice::kAuto;
  const TrackedPeople asked = TrackPeopleToMemory(request, {}, given);
  EXPECT_EQ(asked.people[0].track.motion.body, BuiltinBody().name()) << "the given one";
  ASSERT_TRUE(asked.people[0].summary.head);
  EXPECT_TRUE(asked.people[0].summary.head->ran);
  EXPECT_EQ(asked.people[0].summary.hands[0].why, "the body has no finger joints");
}

TEST_F(HandsOnRealVideo, WithoutTheirNetworksItSaysSoAndRuns) {
  TrackPeopleClipRequest request = Squats();
  request.track.to_s = 0.3;
  const std::string networks = folder_ / "body_alone";
  std::filesystem::create_directory(networks);
  for (const char* file : {kPoseDetectorFile, kPoseLandmarkFullFile}) {
    std::filesystem::create_symlink(std::filesystem::absolute(FindModelFile(file)), networks + "/" + file);
  }
  request.track.detector.models = networks;
  RunBoth(request);
  EXPECT_THAT(ToText(report_), HasSubstr("hands    not looked for: hand_recrop.tflite"));
  EXPECT_TRUE(bytes_ == bytes_without_);
}

TEST_F(TrackPeopleClipOnRealVideo, CancelledItKeepsWhatWasDetected) {
  TrackPeopleClipRequest request = TwoPeople();
  request.track.to_s = 0.6;
  PipelineCallbacks callbacks;
  std::string work;
  callbacks.begin = [&](const std::string& name) { work = name; };
  callbacks.progress = [&](const std::string&, double) { return work != "tracking 2 people"; };
  EXPECT_THROW(TrackPeopleClip(request, callbacks), Cancelled);
  EXPECT_EQ(work, "tracking 2 people");
  std::vector<std::string> left;
  for (const auto& entry : std::filesystem::directory_iterator(request.out)) left.push_back(entry.path().filename());
  EXPECT_EQ(left, std::vector<std::string>{"detections.npz"});
}

TEST_F(TrackPeopleClipOnRealVideo, InMemoryItIsTheSame) {
  TrackPeopleClipRequest request = TwoPeople();
  request.track.to_s = 0.6;
  request.overlay = false;
  TrackPeopleClip(request);
  const TrackedPeople found = TrackPeopleToMemory(request);
  ASSERT_EQ(found.people.size(), 2U);
  EXPECT_EQ(found.report.num_found, 2);
  EXPECT_TRUE(found.report.outputs.empty());
  for (int i = 0; i < 2; ++i) {
    const Track written = ReadTrack(Concatenate(request.out, "/person_", i, ".npz"));
    EXPECT_EQ(found.people[size_t(i)].track.motion.poses, written.motion.poses) << "person " << i;
    EXPECT_EQ(found.people[size_t(i)].track.motion.trans, written.motion.trans) << "person " << i;
  }
  // A camera in memory in the place of one that is estimated.
  GivenInMemory given;
  given.camera = MakePinhole(found.report.width, found.report.height, 1500);
  for (const TrackSequenceResult& person : TrackPeopleToMemory(request, {}, given).people) {
    EXPECT_EQ(person.track.camera.fx, 1500);
  }
}

TEST(TrackPeopleClip, WhatContradictsItselfIsNamed) {
  TrackPeopleClipRequest request;
  const auto run = [&] { TrackPeopleClip(request); };
  EXPECT_THAT(run, ThrowsMessage<RequestError>(HasSubstr("--out is required")));
  request.out = "x";
  request.masks = true;
  request.track.video = "clip.mp4";
  request.track.use_mask = false;
  EXPECT_THAT(run, ThrowsMessage<RequestError>(HasSubstr("--masks")));
  request = {};
  const ScratchFolder folder;
  request.out = folder / "out";
  EXPECT_THAT(run, ThrowsMessage<RequestError>(HasSubstr("the video is required")));
  request.track.video = folder / "clip.mp4";
  EXPECT_THAT(run, ThrowsMessage<std::runtime_error>(HasSubstr("clip.mp4")));
  request.person = 0;
  request.max_people = 2;
  EXPECT_THAT(run, ThrowsMessage<RequestError>(HasSubstr("--person and --people")));
  request.person.reset();
  request.track.stature_m = 1.6;
  EXPECT_THAT(run, ThrowsMessage<RequestError>(HasSubstr("--stature is one person's")));
  request.track.stature_m = 0;
  request.track.camera = "weak";
  EXPECT_THAT(run, ThrowsMessage<RequestError>(HasSubstr("weak perspective")));
  request.track.camera = "";
  request.side_view = true;
  request.overlay = false;
  EXPECT_THAT(run, ThrowsMessage<RequestError>(HasSubstr("--side-view")));
  request.side_view = false;
  request.overlay = true;
  EXPECT_FALSE(std::filesystem::exists(request.out)) << "nothing was made";
  // The results would replace the video.
  request.out = folder / ".";
  request.track.video = folder / "overlay.mp4";
  WriteFileAtomically(request.track.video, "a video");
  EXPECT_THAT(run, ThrowsMessage<RequestError>(HasSubstr("overlay.mp4")));
  EXPECT_EQ(FileBytes(request.track.video), "a video");
}

}  // namespace
}  // namespace bodyloom::track_people_clip_test
