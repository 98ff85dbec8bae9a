// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/evaluation/pose2sim_evaluation.h"

#include <filesystem>

#include "bodyloom/data_tools/observations/load_cameras.h"
#include "bodyloom/data_tools/observations/load_detections.h"

namespace bodyloom {
MultiViewClip ReadPose2SimClip(const std::string& folder, const Pose2SimOptions& options) {
  const std::filesystem::path root(folder);
  const std::vector<NamedCamera> cameras = LoadCameras((root / "calib_refined.json").string());
  MultiViewClip clip;
  clip.name = options.trial;
  clip.fps = options.fps;
  for (const char* number : {"01", "02"}) {
    const std::string detections =
        (root / options.trial / "json_single" / ("cam" + std::string(number) + "_json")).string();
    const NamedCamera& camera = FindCamera(cameras, "cam_" + std::string(number), folder);
    LoadDetectionsOptions load;
    load.fps = options.fps;
    load.image_width = camera.camera.width;
    load.image_height = camera.camera.height;
    clip.views.push_back(
        {camera.name, camera.camera, camera.pose, AsCoco17(LoadDetections(detections, load), detections)});
  }
  clip.coco17_in_world = TriangulateViews(clip.views, options.triangulation);
  return clip;
}

Evaluation EvaluatePose2Sim(const Track& track, const MultiViewClip& clip, const std::string& view,
                            const Pose2SimOptions& options) {
  Evaluation result = EvaluateTriangulatedClip(track, clip, view, options.triangulation);
  result.protocol = "pose2sim-held-out";
  return result;
}

Evaluation EvaluatePose2Sim(const Track& track, const std::string& folder, const std::string& view,
                            const Pose2SimOptions& options) {
  return EvaluatePose2Sim(track, ReadPose2SimClip(folder, options), view, options);
}

}  // namespace bodyloom
