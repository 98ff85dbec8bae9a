// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/evaluation/truth_evaluation.h"

#include <algorithm>
#include <cmath>

#include "bodyloom/data_tools/evaluation/knee_flexion.h"
#include "bodyloom/data_tools/evaluation/metrics.h"
#include "bodyloom/data_tools/evaluation/metrics_image.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/posed_body.h"
#include "bodyloom/geometry/skinning.h"

namespace bodyloom {
namespace {

constexpr double kMm = 1e3;

/// The poses of both tracks on the same joints: columns that one of them lacks are at rest.
RowMatrixXd WithColumns(const RowMatrixXd& poses, Eigen::Index columns) {
  RowMatrixXd result = RowMatrixXd::Zero(poses.rows(), columns);
  result.leftCols(std::min(columns, poses.cols())) = poses.leftCols(std::min(columns, poses.cols()));
  return result;
}

std::vector<MatrixX3d> SkinFrames(const Skinner& skinner, const ShapedBody& body, const std::vector<BodyPose>& poses) {
  std::vector<double> values(3 * poses.size() * skinner.num_vertices());
  skinner.Skin(body, poses, values);
  std::vector<MatrixX3d> frames;
  for (size_t t = 0; t < poses.size(); ++t) {
    const double* begin = values.data() + 3 * t * skinner.num_vertices();
    frames.emplace_back(Eigen::Map<const MatrixX3d>(begin, skinner.num_vertices(), 3));
  }
  return frames;
}

/// Mean distance of the two shapes' vertices in the rest pose, pelvis on pelvis, metres.
double ShapeError(const BodyModel& body, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const auto centred = [&](const Eigen::VectorXd& betas) {
    MatrixX3d vertices = ShapeVertices(body, betas);
    vertices.rowwise() -= Eigen::RowVector3d(body.RestJoints(betas).row(0));
    return vertices;
  };
  return (centred(a) - centred(b)).rowwise().norm().mean();
}

}  // namespace

Evaluation EvaluateAgainstTruth(const Track& track, const Track& truth, const BodyModel& body,
                                const EvaluateAgainstTruthOptions& options) {
  const int T = truth.num_frames();
  BODYLOOM_CHECK(T > 0, "EvaluateAgainstTruth: the truth has no frames");
  BODYLOOM_CHECK(track.num_frames() == T, "EvaluateAgainstTruth: the track has ", track.num_frames(),
                 " frames, the truth has ", T);
  BODYLOOM_CHECK(options.vertex_step >= 1, "EvaluateAgainstTruth: vertex_step ", options.vertex_step,
                 " must be positive");

  Evaluation result;
  result.protocol = "known-truth";
  result.description =
      "Each frame against the true one, both posed on the body '" + body.name() +
      "' and seen through their own cameras. Projection: distance of corresponding vertices in an image scaled to " +
      std::to_string(options.image_side_px) + "x" + std::to_string(options.image_side_px) +
      " by its longer side, mean and standard deviation over frames' means (paper A, Table 4). MPJPE and PVE after "
      "moving pelvis onto pelvis; PA-MPJPE after one similarity a frame. A frame without a result is scored with the "
      "nearest frame that has one.";
  result.frames = T;

  std::vector<bool> has_result(T);
  for (int t = 0; t < T; ++t) has_result[t] = track.HasResult(t);
  result.frames_without_result = static_cast<int>(std::count(has_result.begin(), has_result.end(), false));
  const std::vector<int> source = NearestFramesWithResult(has_result);
  if (source.empty()) return result;

  SkinnerOptions skinning;
  skinning.num_threads = options.num_threads;
  for (int v = 0; v < body.num_vertices(); v += options.vertex_step) skinning.vertices.push_back(v);
  const Skinner skinner(body, skinning);
  const ShapedBody shaped = skinner.Shape(track.motion.betas), true_shaped = skinner.Shape(truth.motion.betas);

  const Motion& estimate = track.motion;
  ProjectionErrorAccumulator projection(
      SquareImageScale(truth.camera.width, truth.camera.height, options.image_side_px));
  PositionErrorAccumulator vertex_errors;
  std::vector<MatrixX3d> joints(T), true_joints(T);
  RowMatrixXd poses(T, estimate.poses.cols());
  constexpr int kChunk = 64;  // frames whose vertices are held at a time
  for (int begin = 0; begin < T; begin += kChunk) {
    const int end = std::min(T, begin + kChunk);
    std::vector<BodyPose> own, true_own;
    for (int t = begin; t < end; ++t) {
      const int f = source[t];
      poses.row(t) = estimate.poses.row(f);
      own.push_back(PoseFromAxisAngle(body, estimate.poses.row(f).transpose(), estimate.trans.row(f).transpose()));
      true_own.push_back(
          PoseFromAxisAngle(body, truth.motion.poses.row(t).transpose(), truth.motion.trans.row(t).transpose()));
      joints[t] = PoseSkeleton(body, shaped.rest_joints, own.back()).joints;
      true_joints[t] = PoseSkeleton(body, true_shaped.rest_joints, true_own.back()).joints;
    }
    const std::vector<MatrixX3d> vertices = SkinFrames(skinner, shaped, own);
    const std::vector<MatrixX3d> true_vertices = SkinFrames(skinner, true_shaped, true_own);
    for (int t = begin; t < end; ++t) {
      const MatrixX3d &a = vertices[t - begin], &b = true_vertices[t - begin];
      projection.AddFrame(ProjectPoints(track.CameraAt(source[t]), a), ProjectPoints(truth.CameraAt(t), b));
      const Eigen::RowVector3d pelvis_offset = joints[t].row(0) - true_joints[t].row(0);
      vertex_errors.AddFrame(((a - b).rowwise() - pelvis_offset).rowwise().norm());
    }
  }

  const ProjectionError px = projection.Result();
  const std::string image = " in an image of " + std::to_string(options.image_side_px) + " px";
  result.Add("projection_mean_px", px.mean_px, "per-vertex projection error" + image);
  result.Add("projection_std_px", px.std_frames_px, "its standard deviation over frames' means");
  result.Add("projection_std_vertices_px", px.std_vertices_px, "and over all frames and vertices");
  result.Add("projection_rms_px", px.rms_px, "its root mean square");
  result.Add("projection_p95_px", px.frames_px.p95, "95th percentile of frames' means");
  result.Add("pve_mm", vertex_errors.Result().mean * kMm, "vertex error, pelvis aligned");

  const MatrixX3d roots = RootPositions(joints, {0}), true_roots = RootPositions(true_joints, {0});
  const std::vector<MatrixX3d> relative = RelativeTo(joints, roots),
                               true_relative = RelativeTo(true_joints, true_roots);
  const double scale = ClipScale(relative, true_relative);
  const PositionError pa = ProcrustesPositionError(joints, true_joints);
  const PositionError mpjpe = MeanPositionError(relative, true_relative);
  result.Add("mpjpe_mm", mpjpe.mean * kMm, "joint error, pelvis aligned");
  result.Add("mpjpe_scaled_mm", MeanPositionError(relative, true_relative, scale).mean * kMm,
             "the same with one scale for the clip");
  result.Add("clip_scale", scale, "that scale: true size / estimated size");
  result.Add("pa_mpjpe_mm", pa.mean * kMm, "joint error after one similarity a frame");
  result.Add("pa_p95_mm", pa.frames.p95 * kMm, "95th percentile of frames");
  const MotionError acceleration = AccelerationError(joints, true_joints, truth.motion.timestamps);
  result.Add("accel_err_ms2", acceleration.mean, "acceleration error, m/s2");
  result.Add("gt_accel_ms2", acceleration.mean_truth, "true acceleration, m/s2");
  result.Add("jitter_ms3", Jitter(joints, truth.motion.timestamps), "mean jerk, m/s3");
  result.Add("gt_jitter_ms3", Jitter(true_joints, truth.motion.timestamps), "true mean jerk, m/s3");

  const Eigen::Index columns = std::max(poses.cols(), truth.motion.poses.cols());
  const JointAngleError angles =
      MeanJointAngleError(WithColumns(poses, columns), WithColumns(truth.motion.poses, columns));
  result.Add("joint_angle_err_deg", angles.mean_deg, "rotation error of joints relative to their parents");
  result.Add("root_rotation_err_deg", angles.root_deg, "rotation error of the body in the camera frame");
  AddKneeFlexion(estimate, &truth.motion, &result);
  // A weak-perspective camera does not determine where the body stands.
  const bool has_depth = track.camera.model == CameraModel::kPinhole && truth.camera.model == CameraModel::kPinhole;
  const RootError root = has_depth ? RootPositionError(roots, true_roots) : RootError{};
  result.Add("root_err_mm", root.distance.mean * kMm, "pelvis error");
  result.Add("root_lateral_err_mm", root.lateral * kMm, "its part across the viewing direction");
  result.Add("root_depth_err_mm", root.depth * kMm, "its part in depth");
  result.Add("shape_err_mm", ShapeError(body, estimate.betas, truth.motion.betas) * kMm,
             "vertex error of the shapes in the rest pose");
  result.Add("focal_err_percent", has_depth ? 100 * (track.camera.fx / truth.camera.fx - 1) : kNotMeasured,
             "focal length, estimated / true - 1");

  const auto breakdown = [&](const std::string& name, const Eigen::VectorXd& values, double factor) {
    EvaluationBreakdown entry{name, {}, {}};
    for (Eigen::Index j = 0; j < values.size(); ++j) {
      entry.labels.push_back(body.data().joint_names[j]);
      entry.values.push_back(values[j] * factor);
    }
    result.breakdowns.push_back(std::move(entry));
  };
  breakdown("mpjpe_mm", mpjpe.per_point, kMm);
  breakdown("joint_angle_err_deg", angles.per_joint_deg, 1);
  return result;
}

}  // namespace bodyloom
