// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/describe/axes_pose.h"

#include <optional>

#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/observations/load_cameras.h"
#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {
namespace {

CameraPose WorldPoseOf(const std::string& track) {
  if (track.empty()) return LevelCamera();
  const std::optional<WorldFrame> world = ReadTrack(track, MovingCamera::kTake).world;
  return world ? world->camera_pose() : LevelCamera();
}

}  // namespace

void SetAxesPose(const std::string& cameras, const std::string& view, const std::string& track, SurfaceMotion* motion) {
  if (motion->frame == SurfaceFrame::kWorld) {
    motion->camera_pose = cameras.empty() ? WorldPoseOf(track) : FindCamera(LoadCameras(cameras), view, cameras).pose;
  } else if (!cameras.empty()) {
    throw RequestError("--cameras is for --frame world");
  }
}

}  // namespace bodyloom
