// SPDX-License-Identifier: Apache-2.0
// Uses of a camera's motion by jobs: which paths a scene takes, and what is said.
#include "pipelines/track/found_camera_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "data_tools/video/video_writer.h"
#include "geometry/base/units.h"
#include "tests/support/scratch_folder.h"
#include "tests/tracking/camera_motion/synthetic_background.h"

namespace bodyloom::found_camera_motion_test {
namespace {

struct Found {
  SceneInputs scene;
  CameraPathReport report;
  std::string said;
};

Found Find(const SyntheticBackground& background, const TrackSettings& request,
           CameraKnowledge knowledge = CameraKnowledge::kUnknownFocal) {
  Found found;
  found.scene.camera.camera = MakePinhole(background.width, background.height, background.focal_px);
  found.scene.camera_knowledge = knowledge;
  found.scene.video.width = found.scene.video.stored_width = background.width;
  found.scene.video.height = found.scene.video.stored_height = background.height;
  PipelineCallbacks callbacks;
  callbacks.message = [&](const std::string& text) { found.said += text; };
  UseCameraMotion(request, TracksOf(background), callbacks, &found.scene, &found.report);
  return found;
}

TrackSettings OfVideo() {
  TrackSettings request;
  request.video = "clip.mp4";
  return request;
}

TEST(FoundCameraMotion, ACameraThatTurnsGivesAPathAndAFocalLength) {
  SyntheticBackground background;
  background.pose = [](double t) { return Tremor(t, 2); };
  const Found found = Find(background, OfVideo());
  ASSERT_TRUE(found.scene.camera_path.has_value());
  EXPECT_EQ(found.scene.camera_path->poses.size(), size_t(background.frames));
  EXPECT_TRUE(found.scene.camera_path->is_metric);
  EXPECT_TRUE(found.report.found);
  EXPECT_EQ(found.report.motion.rfind("turning: ", 0), 0u) << found.report.motion;
  ASSERT_TRUE(found.scene.ForTracker().focal_prior.has_value());
  EXPECT_NEAR(found.scene.ForTracker().focal_prior->log_mean, std::log(background.focal_px), 0.02);
  EXPECT_EQ(found.said, "");
  const Found known = Find(background, OfVideo(), CameraKnowledge::kKnown);
  EXPECT_TRUE(known.report.found);
  EXPECT_FALSE(known.scene.focal_of_motion.has_value());
}

TEST(FoundCameraMotion, AStillCameraStaysWithoutAPath) {
  const Found found = Find({}, OfVideo());
  EXPECT_FALSE(found.scene.camera_path.has_value());
  EXPECT_TRUE(found.report.is_still);
  EXPECT_EQ(found.said, "");
  GroundSummary fast;
  fast.standing_speed_mps = 1;
  EXPECT_EQ(MovingCameraWarning(found.report, {}, fast), "");
  EXPECT_NE(MovingCameraWarning({}, {}, fast), "");
}

/// Goes sideways and turns a little before things 3 to 12 m away.
SyntheticBackground Walk() {
  SyntheticBackground background;
  background.nearest_m = 3;
  background.farthest_m = 12;
  background.frames_of_anchor = 25;
  background.pose = [](double t) {
    return CameraPose{Tremor(t, 1).camera_from_world_rotation, Eigen::Vector3d(-0.4 * t, 0.05 * std::sin(5 * t), 0)};
  };
  return background;
}

TEST(FoundCameraMotion, ACameraThatGoesSomewhereGivesAPathOfUnknownLength) {
  const Found found = Find(Walk(), OfVideo());
  ASSERT_TRUE(found.scene.camera_path.has_value()) << found.report.motion;
  EXPECT_FALSE(found.scene.camera_path->is_metric);
  EXPECT_EQ(CameraScaleOf(OfVideo(), *found.scene.camera_path), 0);
  ASSERT_NE(found.scene.ForTracker().background_points, nullptr);
  EXPECT_GE(found.scene.ForTracker().background_points->size(), 16U);
  EXPECT_EQ(found.report.motion.rfind("moving: ", 0), 0u) << found.report.motion;
  EXPECT_TRUE(found.report.goes);
  EXPECT_GT(found.report.background_points, 50);
  EXPECT_GT(found.report.sigma_place, 0);
  EXPECT_LT(found.report.sigma_place, 0.05);
  ASSERT_TRUE(found.scene.focal_of_motion.has_value());
  EXPECT_NEAR(found.scene.focal_of_motion->log_mean, std::log(1000.0), 0.05);
  EXPECT_EQ(found.said, "");
  CameraPathSummary solved;
  solved.moves = solved.estimated = true;
  solved.scale_m = 2.5;
  solved.why = "feet";
  EXPECT_NE(ToText(found.report, solved).find("points in space"), std::string::npos) << ToText(found.report, solved);
  EXPECT_NE(ToText(found.report, solved).find("from feet"), std::string::npos) << ToText(found.report, solved);
}

TEST(FoundCameraMotion, APathOfUnknownLengthIsReadAsItIsWritten) {
  const ScratchFolder folder;
  for (const char* name : {"path.json", "images.txt"}) {
    TrackSettings request = OfVideo();
    request.camera_path_out = folder / name;
    const SyntheticBackground background = Walk();
    const Found found = Find(background, request);
    ASSERT_TRUE(found.scene.camera_path.has_value());
    const RecordedCameraPath read = LoadCameraPath(request.camera_path_out);
    EXPECT_FALSE(read.is_metric) << name;
    const std::vector<double> seconds = TracksOf(background).timestamps;
    const CameraPath path = CameraPathOnClock(read, seconds, {}, name);
    EXPECT_EQ(path.timestamps, found.scene.camera_path->seconds) << name;
    const CameraPose &expected = found.scene.camera_path->poses.back(), &last = path.poses.back();
    EXPECT_LT(RotationAngleBetween(last.camera_from_world_rotation, expected.camera_from_world_rotation), 1e-7);
    EXPECT_LT((last.camera_from_world_translation - expected.camera_from_world_translation).norm(), 1e-9);
    EXPECT_EQ(read.camera.has_value(), std::string(name) == "images.txt");
  }
  EXPECT_NEAR(LoadCameraPath(folder / "images.txt").camera->fx, 1000, 50);
}

TEST(FoundCameraMotion, OtherMotionIsSaidAndNotUsed) {
  SyntheticBackground leaves;
  leaves.noise_px = 3;
  leaves.pose = Walk().pose;
  leaves.nearest_m = 3, leaves.farthest_m = 12;
  leaves.wanderers = 0.7;
  const Found moving = Find(leaves, OfVideo());
  EXPECT_FALSE(moving.scene.camera_path.has_value());
  EXPECT_NE(moving.said.find("--camera-path"), std::string::npos) << moving.report.motion;
  SyntheticBackground zooming;
  zooming.pose = [](double t) { return Tremor(t, 1); };
  zooming.zoom = [](double t) { return 1 + 0.1 * t; };
  const Found zoomed = Find(zooming, OfVideo());
  EXPECT_FALSE(zoomed.scene.camera_path.has_value());
  EXPECT_NE(zoomed.said.find("zooms"), std::string::npos) << zoomed.said;
}

TEST(FoundCameraMotion, ThePathIsWrittenAsItIsRead) {
  const ScratchFolder folder;
  TrackSettings request = OfVideo();
  request.camera_path_out = folder / "path.json";
  SyntheticBackground background;
  background.pose = [](double t) { return Tremor(t, 2); };
  const Found found = Find(background, request);
  const RecordedCameraPath read = LoadCameraPath(request.camera_path_out);
  ASSERT_EQ(read.poses.size(), found.scene.camera_path->poses.size());
  EXPECT_EQ(read.seconds, found.scene.camera_path->seconds);
  EXPECT_LT(RotationAngleBetween(read.poses.back().camera_from_world_rotation,
                                 found.scene.camera_path->poses.back().camera_from_world_rotation),
            1e-9);
}

TEST(FoundCameraMotion, IsLookedForUnlessSomethingSaysOtherwise) {
  EXPECT_EQ(WhyNoCameraMotion(OfVideo()), "");
  EXPECT_NE(WhyNoCameraMotion(TrackSettings()), "");
  TrackSettings request = OfVideo();
  request.find_camera_motion = false;
  EXPECT_EQ(WhyNoCameraMotion(request), "switched off");
  request = OfVideo();
  request.camera_path = "path.json";
  EXPECT_NE(WhyNoCameraMotion(request), "");
  request = OfVideo();
  request.camera = "weak";
  EXPECT_NE(WhyNoCameraMotion(request), "");
}

TEST(FoundCameraMotion, PointsOfAVideoLeaveThePersonOut) {
  const ScratchFolder folder;
  TrackRequest request;
  request.video = folder / "clip.mp4";
  constexpr int kWidth = 320, kHeight = 240;
  VideoWriter writer(request.video, kWidth, kHeight, 30);
  for (int t = 0; t < 8; ++t) {
    Image frame(kWidth, kHeight, {120, 120, 120});
    for (int k = 0; k < 60; ++k) {
      const int x0 = (k * 37 + 3 * t) % (kWidth - 12), y0 = (k * 53) % (kHeight - 12);
      for (int y = y0; y < y0 + 9; ++y) {
        for (int x = x0; x < x0 + 9; ++x) std::fill_n(frame.pixel(x, y), 3, uint8_t(60 + 3 * k));
      }
    }
    writer.Write(frame);
  }
  writer.Finish();
  SceneInputs scene;
  scene.camera.camera = MakePinhole(kWidth, kHeight, 300);
  KeypointSequence person;
  person.names = {"nose", "ankle"};
  person.timestamps = {0};
  person.points = {{100, 60, 1}, {160, 200, 1}};
  const BackgroundTracks tracks = BackgroundOfVideo(request, &person, scene);
  EXPECT_EQ(tracks.timestamps.size(), 8u);
  ASSERT_FALSE(tracks.anchors.empty());
  EXPECT_GT(tracks.anchors[0].pixels.size(), 10u);
  for (const Eigen::Vector2f& at : tracks.anchors[0].pixels) {
    EXPECT_FALSE(at.x() > 82 && at.x() < 178 && at.y() > 42 && at.y() < 218) << at.transpose();
  }
}

}  // namespace
}  // namespace bodyloom::found_camera_motion_test
