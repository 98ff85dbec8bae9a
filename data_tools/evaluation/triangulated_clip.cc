// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/triangulated_clip.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <stdexcept>

#include "data_tools/evaluation/metrics.h"
#include "data_tools/evaluation/metrics_image.h"
#include "data_tools/observations/load_cameras.h"
#include "data_tools/observations/load_detections.h"
#include "geometry/scene/camera_path.h"

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

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

TriangulatedPoint TriangulatePoint(std::span<const Sighting> sightings) {
  TriangulatedPoint result;
  // Nearest point to all rays: Σ (I − d dᵀ)(X − c) = 0.
  Matrix3d A = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (const Sighting& s : sightings) {
    const Vector2d ray = s.camera->Unproject(s.pixel);
    if (!ray.allFinite()) return result;
    const Matrix3d world_from_camera = s.pose->camera_from_world_rotation.transpose();
    const Vector3d d = (world_from_camera * Vector3d(ray.x(), ray.y(), 1)).normalized();
    const Vector3d centre = -world_from_camera * s.pose->camera_from_world_translation;
    const Matrix3d across = Matrix3d::Identity() - d * d.transpose();
    A += across;
    b += across * centre;
  }
  // Two rays at the angle γ give det A = 2 sin²γ; a single ray or parallel ones give 0.
  const double sine = std::sin(std::numbers::pi / 180);
  if (A.determinant() < 2 * sine * sine) return result;
  Vector3d X = A.ldlt().solve(b);

  constexpr int kIterations = 10;
  for (int iteration = 0; iteration <= kIterations; ++iteration) {
    Matrix3d H = Matrix3d::Zero();
    Vector3d g = Vector3d::Zero();
    double squares = 0;
    for (const Sighting& s : sightings) {
      const Matrix3d& R = s.pose->camera_from_world_rotation;
      Vector2d pixel;
      Matrix2x3d d_pixel;
      if (!s.camera->Project(R * X + s.pose->camera_from_world_translation, &pixel, &d_pixel)) return result;
      const Matrix2x3d J = d_pixel * R;
      const Vector2d r = pixel - s.pixel;
      H.noalias() += J.transpose() * J;
      g.noalias() += J.transpose() * r;
      squares += r.squaredNorm();
    }
    result.point_in_world = X;
    result.rms_px = std::sqrt(squares / static_cast<double>(sightings.size()));
    const Vector3d step = H.ldlt().solve(g);
    if (!step.allFinite()) return result;
    if (step.norm() < 1e-9) break;
    X -= step;
  }
  result.is_valid = true;
  return result;
}

MultiViewClip ReadPose2SimClip(const std::string& folder, const Pose2SimOptions& options) {
  const std::filesystem::path root(folder);
  const std::vector<NamedCamera> cameras = LoadCameras((root / "calib_refined.json").string());
  MultiViewClip clip;
  clip.name = options.trial;
  clip.fps = options.fps;
  clip.up_in_world = Eigen::Vector3d::UnitZ();
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
