// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/describe/axes_pose.h"

#include "bodyloom/data_tools/observations/load_cameras.h"
#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {

void SetAxesPose(const std::string& cameras, const std::string& view, SurfaceMotion* motion) {
  if (motion->frame == SurfaceFrame::kWorld) {
    motion->camera_pose = cameras.empty() ? LevelCamera() : FindCamera(LoadCameras(cameras), view, cameras).pose;
  } else if (!cameras.empty()) {
    throw RequestError("--cameras is for --frame world");
  }
}

}  // namespace bodyloom
