// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/evaluation/triangulated_clip.h"

#include <algorithm>
#include <stdexcept>

#include "bodyloom/data_tools/evaluation/metrics.h"
#include "bodyloom/data_tools/evaluation/metrics_image.h"
#include "bodyloom/data_tools/evaluation/triangulation.h"
#include "bodyloom/geometry/camera_path.h"

namespace bodyloom {
namespace {

bool IsSeen(const Keypoint& point, double min_confidence) {
  return point.confidence > static_cast<float>(min_confidence);
}

}  // namespace

KeypointSequence AsCoco17(const KeypointSequence& detections, const std::string& where) {
  KeypointSequence result = detections;
  result.convention = "coco17";
  result.names = CocoNames();
  result.points.clear();
  std::vector<int> index;
  for (const std::string& name : result.names) {
    const auto it = std::find(detections.names.begin(), detections.names.end(), name);
    if (it == detections.names.end())
      throw std::runtime_error(where + ": no landmark '" + name + "', expected COCO's 17");
    index.push_back(static_cast<int>(it - detections.names.begin()));
  }
  for (int t = 0; t < detections.num_frames(); ++t) {
    for (int k : index) result.points.push_back(detections.at(t, k));
  }
  return result;
}

std::vector<MatrixX3d> TriangulateViews(const std::vector<RigView>& views, const TriangulatedClipOptions& options) {
  int num_frames = views[0].detections.num_frames();
  for (const RigView& view : views) num_frames = std::min(num_frames, view.detections.num_frames());
  std::vector<MatrixX3d> result(num_frames, MatrixX3d::Constant(17, 3, kNotMeasured));
  for (int t = 0; t < num_frames; ++t) {
    for (int k = 0; k < 17; ++k) {
      std::vector<Sighting> sightings;
      for (const RigView& view : views) {
        const Keypoint& point = view.detections.at(t, k);
        if (IsSeen(point, options.min_confidence)) sightings.push_back({&view.camera, &view.pose, {point.x, point.y}});
      }
      const TriangulatedPoint joint = TriangulatePoint(sightings);
      if (joint.is_valid && joint.rms_px <= options.max_triangulation_px) {
        result[t].row(k) = joint.point_in_world.transpose();
      }
    }
  }
  return result;
}

Evaluation EvaluateTriangulatedClip(const Track& track, const MultiViewClip& clip, const std::string& view,
                                    const TriangulatedClipOptions& options) {
  EvaluateHeldOutViewsOptions held_out;
  held_out.min_confidence = options.min_confidence;
  Evaluation result = EvaluateHeldOutViews(track, clip, view, held_out);
  result.protocol = "rig-held-out";
  result.description =
      "The track was fitted to one camera. The middle of its hips is moved to where all cameras' detections, "
      "triangulated, have it, and the clip gets one scale (least squares to the triangulated joints); then its COCO "
      "landmarks are projected into the other camera and compared with the detections there (confidence above 0.3). "
      "There is no 3D truth: MPJPE, PA-MPJPE and accelerations are against the triangulated joints, whose own distance "
      "to the detections bounds the noise from below (two cameras see only its part across the epipolar lines).";
  ReprojectionErrors floor;
  int64_t known = 0, all = 0;
  for (const MatrixX3d& joints : clip.coco17_in_world) {
    for (Eigen::Index k = 0; k < joints.rows(); ++k) known += joints.row(k).allFinite() ? 1 : 0;
    all += joints.rows();
  }
  for (const RigView& rig_view : clip.views) {
    std::vector<MatrixX2d> pixels;
    for (const MatrixX3d& joints : clip.coco17_in_world) {
      pixels.push_back(ProjectPoints(rig_view.camera, MovedPoints(rig_view.pose, joints)));
    }
    AddReprojectionErrors(pixels, rig_view.detections, options.min_confidence, &floor);
  }
  const ErrorStatistics px = Summarize(floor.px);
  result.Add("triangulation_median_px", px.median, "triangulated joints against the detections of both");
  result.Add("triangulation_p95_px", px.p95, "its 95th percentile");
  result.Add("triangulated_percent", all > 0 ? 100.0 * static_cast<double>(known) / static_cast<double>(all) : 0,
             "joints that could be triangulated");
  return result;
}

}  // namespace bodyloom
