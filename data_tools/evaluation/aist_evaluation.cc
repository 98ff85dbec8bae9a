// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/evaluation/aist_evaluation.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "bodyloom/data_tools/evaluation/metrics.h"
#include "bodyloom/data_tools/evaluation/pseudo_truth.h"
#include "bodyloom/data_tools/evaluation/vertex_errors.h"
#include "bodyloom/data_tools/formats/pickle.h"
#include "bodyloom/data_tools/motion/aist_motion.h"
#include "bodyloom/data_tools/observations/aist_reader.h"
#include "bodyloom/data_tools/observations/load_cameras.h"
#include "bodyloom/geometry/base/units.h"

namespace bodyloom {
namespace {

constexpr int kSmplVertices = 6890;

/// Per-vertex projection error against the recording's own SMPL motion.
void AddPublishedMotion(const Track& track, const MultiViewClip& clip, const std::string& view, const BodyModel& body,
                        Evaluation* result) {
  const auto own = std::find_if(clip.views.begin(), clip.views.end(), [&](const RigView& v) { return v.name == view; });
  const bool smpl = body.num_vertices() == kSmplVertices;
  const PseudoTruth truth =
      MakePseudoTruth(clip, *own, body, smpl ? PseudoTruthShape::kAsPublished : PseudoTruthShape::kFitted);
  const std::vector<int> source =
      NearestFramesWithResult(HasResults(track, std::min(track.num_frames(), truth.track.num_frames())));
  if (source.empty()) return;
  const VertexErrorOptions options;
  const VertexErrors errors = CompareVertices(track, source, truth.track, body, options);
  AddProjectionError(errors.projection, options.image_side_px, result);
  // Published translations are in the template's size, the track's in its own: lengths do not compare.
  if (!smpl) {
    result->Add("pve_mm", errors.position.mean * kMmPerMetre, "vertex error, pelvis aligned");
  }
  result->Add("truth_landmark_err_mm", truth.landmark_error_m * kMmPerMetre,
              "distance of the published motion's own landmarks to keypoints3d_optim");
  result->description +=
      " Projection: distance of corresponding vertices of the track's body and of smpl_poses on the body '" +
      body.name() +
      (smpl ? "', beta = 0 and smpl_trans as published"
            : "', whose shape and place are fitted to keypoints3d_optim, as SMPL's own template is not "
              "this body's") +
      ", each through its own camera, in an image scaled to 512x512 by its longer side (paper A, Table 4).";
}

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
  if (std::filesystem::exists(motion)) {
    const PicklePtr file = ReadPickleFile(motion);
    clip.motion = AistMotionFromPickle(*file, motion);
    clip.motion_scale = AistBodyScale(*file, motion);
  }
  const PicklePtr detections = ReadPickleFile(keypoints);
  for (const NamedCamera& camera : LoadCameras(cameras_folder, sequence)) {
    clip.views.push_back({camera.name, camera.camera, camera.pose,
                          AistKeypoints2dFromPickle(*detections, keypoints, camera.name, kAistFps)});
  }
  return clip;
}

Evaluation EvaluateAist(const Track& track, const MultiViewClip& clip, const std::string& view, const BodyModel* body) {
  Evaluation result = EvaluateHeldOutViews(track, clip, view);
  result.protocol = "aist-held-out";
  result.description =
      "The track was fitted to one camera's detections. MPJPE (mid-hip aligned, and with one scale for the clip), "
      "PA-MPJPE (one similarity a frame) and acceleration error (60 frames a second) of its COCO landmarks against "
      "keypoints3d_optim, which was made from all nine cameras. Held-out views: the landmarks with the clip's scale, "
      "mid-hip at the true place, projected into the other eight cameras, against detections with confidence above "
      "0.3. Joint angles against smpl_poses. A frame without a result is scored with the nearest frame that has one. "
      "Noise floor of the detections: median 5.8 px, 95th percentile 16-19 px.";
  if (body != nullptr && clip.motion.num_frames() > 0) AddPublishedMotion(track, clip, view, *body, &result);
  return result;
}

Evaluation EvaluateAist(const Track& track, const std::string& annotations_folder, const std::string& cameras_folder,
                        const std::string& sequence, const std::string& view, const BodyModel* body) {
  return EvaluateAist(track, ReadAistClip(annotations_folder, cameras_folder, sequence), view, body);
}

}  // namespace bodyloom
