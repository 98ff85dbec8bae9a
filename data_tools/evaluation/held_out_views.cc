// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/held_out_views.h"

#include <algorithm>
#include <cmath>

#include "data_tools/evaluation/evaluation.h"
#include "data_tools/evaluation/joint_angle_errors.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/evaluation/metrics_image.h"
#include "data_tools/evaluation/room_errors.h"
#include "data_tools/evaluation/sigma_reliability.h"
#include "geometry/base/check.h"
#include "geometry/body/body_model.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"

namespace bodyloom {
namespace {

constexpr double kMm = 1e3;
const std::vector<int> kCocoHips = {11, 12};

int FindView(const MultiViewClip& clip, const std::string& name) {
  std::string present;
  for (size_t v = 0; v < clip.views.size(); ++v) {
    if (clip.views[v].name == name) return static_cast<int>(v);
    present += (v > 0 ? ", " : "") + clip.views[v].name;
  }
  BODYLOOM_CHECK(false, "the clip '", clip.name, "' has no view '", name, "'; it has ", present);
  return -1;
}

void CheckClip(const MultiViewClip& clip, int num_frames) {
  BODYLOOM_CHECK(num_frames > 0, "the track and the clip '", clip.name, "' have no frame in common");
  BODYLOOM_CHECK(clip.fps > 0, "the clip '", clip.name, "' has the frame rate ", clip.fps);
  for (const RigView& view : clip.views) {
    BODYLOOM_CHECK(view.detections.num_points() == 17, "view '", view.name, "' has ", view.detections.num_points(),
                   " landmarks, expected COCO's 17");
    BODYLOOM_CHECK(view.detections.num_frames() >= num_frames, "view '", view.name, "' has ",
                   view.detections.num_frames(), " frames, expected ", num_frames);
  }
}

/// One view's landmarks in every frame, in pixels.
template <typename CameraOf>
std::vector<MatrixX2d> Projected(const std::vector<MatrixX3d>& points_in_camera, const CameraOf& camera_of) {
  std::vector<MatrixX2d> pixels;
  for (size_t t = 0; t < points_in_camera.size(); ++t) {
    pixels.push_back(ProjectPoints(camera_of(static_cast<int>(t)), points_in_camera[t]));
  }
  return pixels;
}

/// Everything that is measured in pixels, gathered over views.
struct ImageErrors {
  double min_confidence = 0;
  ReprojectionErrors distances;
  CorrectKeypoints box_05, box_10, torso_20;

  void Add(const std::vector<MatrixX2d>& pixels, const KeypointSequence& detections) {
    AddReprojectionErrors(pixels, detections, min_confidence, &distances);
    AddCorrectKeypoints(pixels, detections, 0.05, PckReference::kBox, min_confidence, &box_05);
    AddCorrectKeypoints(pixels, detections, 0.1, PckReference::kBox, min_confidence, &box_10);
    AddCorrectKeypoints(pixels, detections, 0.2, PckReference::kTorso, min_confidence, &torso_20);
  }

  void Report(const std::string& prefix, const std::string& where, Evaluation* result) const {
    const ErrorStatistics px = Summarize(distances.px), percent = Summarize(distances.percent_of_height);
    result->Add(prefix + "_median_px", px.median, "distance to detections in " + where);
    result->Add(prefix + "_p95_px", px.p95, "its 95th percentile");
    result->Add(prefix + "_median_height_percent", percent.median, "median in % of the person's height");
    result->Add(prefix + "_p95_height_percent", percent.p95, "95th percentile in %");
    result->Add(prefix + "_pck_box_05", box_05.Share(), "share within 0.05 of the box around the detections");
    result->Add(prefix + "_pck_box_10", box_10.Share(), "within 0.1 of the box");
    result->Add(prefix + "_pck_torso_20", torso_20.Share(), "within 0.2 of the torso");
    result->Add(prefix + "_not_projected", static_cast<double>(distances.missing),
                "detections whose landmark has no place in the image");
  }
};

void AddBreakdown(const std::string& name, const std::vector<std::string>& labels, const Eigen::VectorXd& values,
                  Evaluation* result) {
  result->breakdowns.push_back({name, labels, {values.data(), values.data() + values.size()}});
}

/// Joint rotations against the clip's SMPL motion.
void AddJointAngles(const Track& track, const std::vector<int>& source, const MultiViewClip& clip, const RigView& own,
                    Evaluation* result) {
  const Eigen::Index T = std::min<Eigen::Index>(static_cast<Eigen::Index>(source.size()), clip.motion.num_frames());
  const Eigen::Index columns = static_cast<Eigen::Index>(3 * SmplParents().size());
  if (track.motion.poses.cols() != columns || clip.motion.poses.cols() != columns || T == 0) return;
  RowMatrixXd poses(T, columns), truth = clip.motion.poses.topRows(T);
  for (Eigen::Index t = 0; t < T; ++t) {
    poses.row(t) = track.motion.poses.row(source[t]);
    const Eigen::Matrix3d root = RotationFromAxisAngle(truth.row(t).head<3>().transpose());
    truth.row(t).head<3>() = AxisAngleFromRotation(own.pose.camera_from_world_rotation * root).transpose();
  }
  const JointAngleError angles = MeanJointAngleError(poses, truth);
  // COCO's landmarks do not determine hands, feet and single vertebrae; these eight carry the motion.
  double limbs = 0;
  const std::vector<int> limb_joints = {1, 2, 4, 5, 16, 17, 18, 19};
  for (int j : limb_joints) limbs += angles.per_joint_deg[j] / static_cast<double>(limb_joints.size());
  result->Add("joint_angle_err_deg", angles.mean_deg, "rotation error of the 23 joints relative to their parents");
  result->Add("limb_angle_err_deg", limbs, "the same for hips, knees, shoulders and elbows");
  result->Add("root_rotation_err_deg", angles.root_deg, "rotation error of the body in the camera frame");
  AddBreakdown("joint_angle_err_deg", SmplJointNames(), angles.per_joint_deg, result);
}

}  // namespace

Evaluation EvaluateHeldOutViews(const Track& track, const MultiViewClip& clip, const std::string& view,
                                const EvaluateHeldOutViewsOptions& options) {
  const RigView& own = clip.views[FindView(clip, view)];
  const int T = std::min(static_cast<int>(track.coco17.size()), static_cast<int>(clip.coco17_in_world.size()));
  CheckClip(clip, T);

  Evaluation result;
  result.protocol = "held-out-views";
  result.subject = {{"clip", clip.name}, {"fitted view", view}};
  result.frames = T;
  std::vector<bool> has_result(T);
  for (int t = 0; t < T; ++t) has_result[t] = track.coco17[t].rows() == 17 && track.coco17[t].allFinite();
  result.frames_without_result = static_cast<int>(std::count(has_result.begin(), has_result.end(), false));
  const std::vector<int> source = NearestFramesWithResult(has_result);
  if (source.empty()) return result;

  std::vector<MatrixX3d> P(T), G(T);  // landmarks of track and clip in the fitted view's camera frame
  std::vector<double> timestamps(T);
  for (int t = 0; t < T; ++t) {
    P[t] = track.coco17[source[t]];
    G[t] = MovedPoints(own.pose, clip.coco17_in_world[t]);
    timestamps[t] = t / clip.fps;
  }
  const MatrixX3d hip_P = RootPositions(P, kCocoHips), hip_G = RootPositions(G, kCocoHips);
  const std::vector<MatrixX3d> p = RelativeTo(P, hip_P), g = RelativeTo(G, hip_G);
  const double scale = ClipScale(p, g);
  const PositionError pa = ProcrustesPositionError(P, G), scaled = MeanPositionError(p, g, scale);
  const MotionError acceleration = AccelerationError(P, G, timestamps);
  const RootError root = RootPositionError(hip_P, hip_G);
  result.Add("clip_scale", scale, "true size / estimated size, one for the clip");
  result.Add("mpjpe_mm", MeanPositionError(p, g).mean * kMm, "landmark error, mid-hip aligned");
  result.Add("mpjpe_scaled_mm", scaled.mean * kMm, "the same with the clip's scale");
  result.Add("pa_mpjpe_mm", pa.mean * kMm, "landmark error after one similarity a frame");
  result.Add("pa_p95_mm", pa.frames.p95 * kMm, "95th percentile of frames");
  result.Add("pa_over_120_percent", PercentAbove(pa.of_frame, kAnotherPose_m), "frames in which it is above 120 mm");
  result.Add("accel_err_ms2", acceleration.mean, "acceleration error, m/s2");
  result.Add("gt_accel_ms2", acceleration.mean_truth, "acceleration of the reference, m/s2");
  result.Add("jitter_ms3", Jitter(P, timestamps), "mean jerk, m/s3");
  result.Add("gt_jitter_ms3", Jitter(G, timestamps), "mean jerk of the reference, m/s3");
  result.Add("root_err_mm", root.distance.mean * kMm, "mid-hip error");
  result.Add("root_lateral_err_mm", root.lateral * kMm, "its part across the viewing direction");
  result.Add("root_depth_err_mm", root.depth * kMm, "its part in depth");
  AddSigmaReliability(JudgedLandmarks(track, source, p, g), &result);
  if (!clip.up_in_world.isZero()) {
    AddRoomErrors(track, G, own.pose.camera_from_world_rotation * clip.up_in_world, timestamps, &result);
  }

  // The track in the world: root where it really was, one scale for the clip.
  std::vector<MatrixX3d> placed_in_world(T);
  const CameraPose world_from_own = Inverse(own.pose);
  for (int t = 0; t < T; ++t) {
    const MatrixX3d placed = (scale * p[t]).rowwise() + Eigen::RowVector3d(hip_G.row(t));
    placed_in_world[t] = MovedPoints(world_from_own, placed);
  }
  ImageErrors held_out{options.min_confidence, {}, {}, {}, {}}, fitted = held_out, fitted_own = held_out;
  EvaluationBreakdown by_view{"heldout_median_px", {}, {}};
  for (const RigView& other : clip.views) {
    if (other.name == own.name) continue;
    std::vector<MatrixX3d> in_other(T);
    for (int t = 0; t < T; ++t) {
      in_other[t] = MovedPoints(other.pose, placed_in_world[t]);
    }
    const std::vector<MatrixX2d> pixels = Projected(in_other, [&](int) { return other.camera; });
    held_out.Add(pixels, other.detections);
    ReprojectionErrors alone;
    AddReprojectionErrors(pixels, other.detections, options.min_confidence, &alone);
    by_view.labels.push_back(other.name);
    by_view.values.push_back(Summarize(alone.px).median);
  }
  fitted.Add(Projected(P, [&](int) { return own.camera; }), own.detections);
  fitted_own.Add(Projected(P, [&](int t) { return track.CameraAt(source[t]); }), own.detections);
  held_out.Report("heldout", "the other views", &result);
  fitted.Report("fitview", "the fitted view, true camera", &result);
  fitted_own.Report("fitview_own", "the fitted view, the track's camera", &result);

  AddKneeFlexion(track.motion, clip.motion.num_frames() > 0 ? &clip.motion : nullptr, &result);
  AddJointAngles(track, source, clip, own, &result);
  result.breakdowns.push_back(std::move(by_view));
  AddBreakdown("pa_mpjpe_mm", CocoNames(), pa.per_point * kMm, &result);
  AddBreakdown("mpjpe_scaled_mm", CocoNames(), scaled.per_point * kMm, &result);
  AddLandmarkAngleErrors(P, G, &result);
  return result;
}

}  // namespace bodyloom
