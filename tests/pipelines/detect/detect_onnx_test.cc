// SPDX-License-Identifier: Apache-2.0
/// A clip with an ONNX network in place of BlazePose, from images to landmarks and tracks. The network is scripted: it
/// detects two people, and the redder an image is, the farther the small one is to the right.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "data_tools/motion/track_io.h"
#include "data_tools/observations/load_detections.h"
#include "data_tools/video/image_file.h"
#include "pipelines/detect/detect_clip.h"
#include "pipelines/track/track_clip.h"
#include "pipelines/track/track_people_clip.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_files.h"
#include "tests/tracking/detection/inference/small_onnx.h"

namespace bodyloom::detect_onnx_test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class OnnxClip : public ::testing::Test {
 protected:
  static constexpr int kFrames = 6;

  /// 320 × 180 pixels, which the 640 × 640 letterbox doubles, with 140 rows of grey above and below.
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "clip");
    for (int t = 0; t < kFrames; ++t) {
      char name[32];
      std::snprintf(name, sizeof name, "clip/%03d.png", t);
      WriteImage(folder_ / name, Image(320, 180, {uint8_t(51 * t), 0, 0}));
    }
    ScriptedPerson walker = ScriptedStanding(120, 320, 200, 0.9F, 0.5F);
    walker.right = 20;
    std::ofstream(folder_ / "net.onnx", std::ios::binary)
        << ScriptedYoloPose({1, 3, 640, 640}, {walker, ScriptedStanding(450, 320, 320, 0.6F, 1)}, 17, 80).Bytes();
  }
  [[nodiscard]] DetectClipRequest Request() const {
    DetectClipRequest request;
    request.detect.video = folder_ / "clip";
    request.detect.span.fps = 30;
    request.detect.detector.pose_model = folder_ / "net.onnx";
    request.detect.detector.models = folder_ / "no networks here";
    request.out = folder_ / "detections.npz";
    return request;
  }
  [[nodiscard]] TrackRequest Track() const {
    TrackRequest request;
    request.video = folder_ / "clip";
    request.detector = Request().detect.detector;
    request.focal_px = 400;
    request.out = folder_ / "track.npz";
    return request;
  }

  const ScratchFolder folder_;
};

TEST_F(OnnxClip, LandmarksAreLinkedAndWritten) {
  DetectClipRequest request = Request();
  request.json = folder_ / "report.json";
  const DetectClipReport report = DetectClip(request);
  EXPECT_EQ(report.frames, kFrames);
  ASSERT_TRUE(report.landmarks.has_value());
  EXPECT_EQ(report.landmarks->network, "net.onnx");
  ASSERT_EQ(report.landmarks->people.size(), 2U);
  EXPECT_EQ(report.landmarks->people[1].frames, kFrames);
  EXPECT_THAT(ToText(report), HasSubstr(" with net.onnx\n"));
  EXPECT_EQ(nlohmann::json::parse(FileBytes(request.json))["network"], "net.onnx");

  LoadDetectionsOptions second;
  second.person = 1;
  const KeypointSequence large = LoadDetections(request.out), small = LoadDetections(request.out, second);
  EXPECT_EQ(large.convention, "coco17");
  EXPECT_EQ(large.image_width, 320);
  EXPECT_NEAR(large.timestamps[3], 0.1, 1e-9);
  for (int t = 0; t < kFrames; ++t) {
    EXPECT_NEAR(large.at(t, 0).x, 450 / 2.0, 1e-3);
    EXPECT_NEAR(large.at(t, 0).y, (320 - 0.44 * 320 - 140) / 2, 1e-3);
    EXPECT_EQ(large.at(t, 0).confidence, 1);
    // Of the letterbox's 640 rows the picture fills 360; the others are grey alike in all frames.
    const double grey = 114.0 / 255 * 280 / 640, red = 0.2 * t * 360 / 640;
    EXPECT_NEAR(small.at(t, 0).x, (120 + 20 * (grey + red)) / 2, 1e-3);
    EXPECT_EQ(small.at(t, 0).confidence, 0.5F);
  }
}

TEST_F(OnnxClip, FramesBetweenAreFilledIn) {
  DetectClipRequest request = Request();
  request.detect.detect_rate = 15;
  const DetectClipReport report = DetectClip(request);
  EXPECT_LT(report.landmarks->detector.frames, kFrames);
  const KeypointSequence large = LoadDetections(request.out);
  for (int t = 0; t < kFrames; ++t) EXPECT_NEAR(large.at(t, 16).x, (450 - 0.07 * 320) / 2, 1e-3);
}

TEST_F(OnnxClip, WhatDoesNotGoTogetherIsSaid) {
  const auto refusal = [](const DetectClipRequest& request, const std::string& words) {
    EXPECT_THAT([&] { DetectClip(request); }, ThrowsMessage<RequestError>(HasSubstr(words)));
  };
  DetectClipRequest mask = Request();
  mask.mask = folder_ / "mask.npz";
  refusal(mask, "--mask is BlazePose's");
  DetectClipRequest boxes = Request();
  std::swap(boxes.detect.detector.pose_model, boxes.detect.detector.box_model);
  refusal(boxes, "--box-model finds people for RTMPose: give --pose-model");
  DetectClipRequest same = Request();
  same.out = same.detect.detector.pose_model;
  refusal(same, "both to read and to write");
  DetectClipRequest absent = Request();
  absent.detect.detector.pose_model = folder_ / "absent.onnx";
  EXPECT_THAT([&] { DetectClip(absent); }, ThrowsMessage<std::runtime_error>(HasSubstr("absent.onnx")));
  TrackRequest track = Track();
  track.detections = folder_ / "net.onnx";
  EXPECT_THAT([&] { CheckTrackRequest(track); }, ThrowsMessage<RequestError>(HasSubstr("leave out the detections")));
  TrackPeopleClipRequest run;
  run.track = Track();
  run.out = folder_ / "out";
  run.masks = true;
  EXPECT_THAT([&] { TrackPeopleClip(run); }, ThrowsMessage<RequestError>(HasSubstr("--masks are BlazePose's")));
}

/// Of the frames' landmarks of arms and legs, the largest distance in pixels to where the person was drawn.
double WorstError(const Track& track, const ScriptedPerson& person) {
  double worst = 0;
  for (int t = 0; t < track.num_frames(); ++t) {
    for (Eigen::Index k = 5; k < 17; ++k) {
      const Eigen::Vector3d at = track.coco17[size_t(t)].row(k);
      const double x = track.camera.fx * at.x() / at.z() + track.camera.cx;
      const double y = track.camera.fy * at.y() / at.z() + track.camera.cy;
      const size_t place = size_t(3 * k);
      worst = std::max(worst, std::hypot(x - person.points[place] / 2, y - (person.points[place + 1] - 140) / 2));
    }
  }
  return worst;
}

TEST_F(OnnxClip, TracksWithoutAMask) {
  EXPECT_FALSE(DetectsMasks(Track()));
  const TrackReport report = TrackClip(Track());
  EXPECT_EQ(report.num_frames, kFrames);
  const ::bodyloom::Track track = ReadTrack(folder_ / "track.npz");
  EXPECT_THAT(track.frame_status, ::testing::Each(FrameStatus::kTracked));
  EXPECT_LT(WorstError(track, ScriptedStanding(450, 320, 320, 1, 1)), 12);  // of a person 160 pixels tall
}

TEST_F(OnnxClip, RunTracksEverybody) {
  TrackPeopleClipRequest request;
  request.track = Track();
  request.out = folder_ / "out";
  request.overlay = false;
  request.min_seconds = 0;
  const TrackPeopleReport report = TrackPeopleClip(request);
  EXPECT_EQ(report.network, "net.onnx");
  ASSERT_EQ(report.people.size(), 2U);
  EXPECT_THAT(report.outputs, Contains(folder_ / "out/person_1.npz"));
  EXPECT_LT(WorstError(ReadTrack(folder_ / "out/person_0.npz"), ScriptedStanding(450, 320, 320, 1, 1)), 12);
}

}  // namespace
}  // namespace bodyloom::detect_onnx_test
