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
  EXPECT_FALSE(known.scene.focal_of_turning.has_value());
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

TEST(FoundCameraMotion, OtherMotionIsSaidAndNotUsed) {
  SyntheticBackground background;
  background.nearest_m = 3;
  background.farthest_m = 12;
  background.pose = [](double t) { return CameraPose{Eigen::Matrix3d::Identity(), {-0.4 * t, 0, 0}}; };
  const Found moving = Find(background, OfVideo());
  EXPECT_FALSE(moving.scene.camera_path.has_value());
  EXPECT_NE(moving.said.find("--camera-path"), std::string::npos) << moving.said;
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
