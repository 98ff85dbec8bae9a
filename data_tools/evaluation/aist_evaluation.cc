// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/evaluation/aist_evaluation.h"

#include <filesystem>

#include "bodyloom/data_tools/formats/pickle.h"
#include "bodyloom/data_tools/motion/load_motion.h"
#include "bodyloom/data_tools/observations/aist_reader.h"
#include "bodyloom/data_tools/observations/load_cameras.h"

namespace bodyloom {
namespace {

constexpr double kAistFps = 60;

}  // namespace

MultiViewClip ReadAistClip(const std::string& annotations_folder, const std::string& cameras_folder,
                           const std::string& sequence) {
  const std::filesystem::path root(annotations_folder);
  const std::string file = sequence + ".pkl";
  const std::string keypoints = (root / "keypoints2d" / file).string();
  const std::string motion = (root / "motions" / file).string();
  MultiViewClip clip;
  clip.name = sequence;
  clip.fps = kAistFps;
  clip.coco17_in_world = ReadAistKeypoints3d((root / "keypoints3d" / file).string());
  if (std::filesystem::exists(motion)) clip.motion = LoadMotion(motion);
  const PicklePtr detections = ReadPickleFile(keypoints);
  for (const NamedCamera& camera : LoadCameras(cameras_folder, sequence)) {
    clip.views.push_back({camera.name, camera.camera, camera.pose,
                          AistKeypoints2dFromPickle(*detections, keypoints, camera.name, kAistFps)});
  }
  return clip;
}

Evaluation EvaluateAist(const Track& track, const MultiViewClip& clip, const std::string& view) {
  Evaluation result = EvaluateHeldOutViews(track, clip, view);
  result.protocol = "aist-held-out";
  result.description =
      "The track was fitted to one camera's detections. MPJPE (mid-hip aligned, and with one scale for the clip), "
      "PA-MPJPE (one similarity a frame) and acceleration error (60 frames a second) of its COCO landmarks against "
      "keypoints3d_optim, which was made from all nine cameras. Held-out views: the landmarks with the clip's scale, "
      "mid-hip at the true place, projected into the other eight cameras, against detections with confidence above "
      "0.3. Joint angles against smpl_poses. A frame without a result is scored with the nearest frame that has one. "
      "Noise floor of the detections: median 5.8 px, 95th percentile 16-19 px.";
  return result;
}

Evaluation EvaluateAist(const Track& track, const std::string& annotations_folder, const std::string& cameras_folder,
                        const std::string& sequence, const std::string& view) {
  return EvaluateAist(track, ReadAistClip(annotations_folder, cameras_folder, sequence), view);
}

}  // namespace bodyloom
