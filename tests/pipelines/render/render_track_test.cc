// SPDX-License-Identifier: Apache-2.0
#include "pipelines/render/render_track.h"

#include <gtest/gtest.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "data_tools/formats/atomic_file.h"
#include "geometry/scene/camera_path.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/short_track.h"

namespace bodyloom::render_track_test {
namespace {

TEST(FrameRange, ReadsWhatUsersWrite) {
  EXPECT_EQ(FrameRange("", 10, "t"), std::make_pair(0, 10));
  EXPECT_EQ(FrameRange("3", 10, "t"), std::make_pair(3, 4));
  EXPECT_EQ(FrameRange("3:", 10, "t"), std::make_pair(3, 10));
  EXPECT_EQ(FrameRange(":7", 10, "t"), std::make_pair(0, 7));
  EXPECT_EQ(FrameRange("3:7", 10, "t"), std::make_pair(3, 7));
  EXPECT_THROW(FrameRange("10", 10, "t"), std::runtime_error);
  EXPECT_THROW(FrameRange("9:11", 10, "t"), std::runtime_error);
  EXPECT_THROW(FrameRange("7:3", 10, "t"), RequestError);
}

/// The bytes of a contact sheet.
std::string SheetOf(const Track& track, RenderKind what, std::optional<double> view_yaw_deg) {
  const ScratchFolder folder;
  RenderTrackRequest request;
  request.track = "track.npz";
  request.what = what;
  request.view_yaw_deg = view_yaw_deg;
  request.out = folder / "sheet.png";
  RenderTrack(request, BuiltinBody(), track, nullptr);
  return ReadFileBytes(request.out);
}

TEST(RenderTrack, ASideViewOfAMovingCamerasTrackStandsInTheScene) {
  const Track moving = ShortTrack(6, SynthCameraMotion::kOrbit);
  Track in_scene = moving;  // body and floor as they are, seen by a camera that stays where the first frame was taken
  in_scene.camera_from_scene.clear();
  EXPECT_EQ(SheetOf(moving, RenderKind::kOverlay, 70), SheetOf(in_scene, RenderKind::kOverlay, 70));
}

TEST(RenderTrack, AMovingCamerasImagesShowTheBodyWhereThatCameraSawIt) {
  const Track moving = ShortTrack(6, SynthCameraMotion::kWalking);
  const Track seen = TrackInCameras(BuiltinBody(), moving);
  EXPECT_EQ(SheetOf(moving, RenderKind::kParts, {}), SheetOf(seen, RenderKind::kParts, {}));
  EXPECT_NE(SheetOf(moving, RenderKind::kOverlay, {}), SheetOf(seen, RenderKind::kOverlay, {}))
      << "the studio's floor moves with the scene";
}

}  // namespace
}  // namespace bodyloom::render_track_test
