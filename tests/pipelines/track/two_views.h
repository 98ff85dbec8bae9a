// SPDX-License-Identifier: Apache-2.0
/// Detections of one synthetic person in two cameras whose clocks differ.
#pragma once

#include <string>

#include "data_tools/formats/npz.h"
#include "data_tools/observations/observations_npz.h"
#include "geometry/scene/camera_path.h"
#include "pipelines/synthesis/synthesize_clip.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom {

struct TwoViews {
  std::string left, right;     ///< detections
  CameraPose right_from_left;  ///< true
  Track truth;                 ///< in the left camera's frame
  double focal_px = 0;         ///< of both
  int width = 0, height = 0;
};

/// The right camera's clock is `offset_s` ahead, and it began `late` frames later.
inline TwoViews MakeTwoViews(const ScratchFolder& folder, double yaw_deg, double offset_s, int late) {
  TwoViews views;
  CameraPose poses[2];
  for (int v = 0; v < 2; ++v) {
    SynthesizeClipRequest request;
    request.motion = {.name = "demo", .fps = 30, .num_frames = 90};
    request.out = folder / (v == 0 ? "left_clip" : "right_clip");
    request.clip.dense_per_frame = 0;
    request.clip.camera.yaw_deg = v == 0 ? 0 : yaw_deg;
    request.clip.seed = static_cast<uint64_t>(v) + 1;
    const SynthesizeClipReport report = SynthesizeClip(request);
    poses[v] = report.clip.camera_from_world;
    KeypointSequence seen = report.clip.keypoints;
    if (v == 0) {
      views.truth = report.clip.truth;
      views.focal_px = views.truth.camera.fx;
      views.width = views.truth.camera.width;
      views.height = views.truth.camera.height;
    } else {
      seen.timestamps.erase(seen.timestamps.begin(), seen.timestamps.begin() + late);
      seen.points.erase(seen.points.begin(), seen.points.begin() + ptrdiff_t(late) * seen.num_points());
      for (double& time : seen.timestamps) time += offset_s;
    }
    (v == 0 ? views.left : views.right) = folder / (v == 0 ? "left.npz" : "right.npz");
    WriteObservations(v == 0 ? views.left : views.right, &seen, nullptr);
  }
  views.right_from_left = Compose(poses[1], Inverse(poses[0]));
  return views;
}

}  // namespace bodyloom
