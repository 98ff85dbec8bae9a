// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/truth_evaluation.h"

#include <algorithm>
#include <cmath>

#include "data_tools/evaluation/evaluation.h"
#include "data_tools/evaluation/joint_angle_errors.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/evaluation/sigma_reliability.h"
#include "data_tools/evaluation/vertex_errors.h"
#include "geometry/base/check.h"
#include "geometry/base/units.h"
#include "geometry/body/posed_body.h"

namespace bodyloom {
namespace {

/// The poses of both tracks on the same joints: columns that one of them lacks are at rest.
RowMatrixXd WithColumns(const RowMatrixXd& poses, Eigen::Index columns) {
  RowMatrixXd result = RowMatrixXd::Zero(poses.rows(), columns);
  result.leftCols(std::min(columns, poses.cols())) = poses.leftCols(std::min(columns, poses.cols()));
  return result;
}

MatrixX3d PosedJoints(const BodyModel& body, const MatrixX3d& rest_joints, const Motion& motion, int t) {
  return PoseSkeleton(body, rest_joints,
                      PoseFromAxisAngle(body, motion.poses.row(t).transpose(), motion.trans.row(t).transpose()))
      .joints;
}

/// The shape's vertices in the rest pose, with the pelvis at the origin.
MatrixX3d CentredShape(const BodyModel& body, const Eigen::VectorXd& betas) {
  MatrixX3d vertices = ShapeVertices(body, betas);
  vertices.rowwise() -= Eigen::RowVector3d(body.RestJoints(betas).row(0));
  return vertices;
}

}  // namespace

Evaluation EvaluateAgainstTruth(const Track& track, const Track& truth, const BodyModel& body,
                                const VertexErrorOptions& options) {
  const int T = truth.num_frames();
  BODYLOOM_CHECK(T > 0, "EvaluateAgainstTruth: the truth has no frames");
  BODYLOOM_CHECK(track.num_frames() == T, "EvaluateAgainstTruth: the track has ", track.num_frames(),
                 " frames, the truth has ", T);

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

  const std::vector<bool> has_result = HasResults(track, T);
  result.frames_without_result = static_cast<int>(std::count(has_result.begin(), has_result.end(), false));
  const std::vector<int> source = NearestFramesWithResult(has_result);
  if (source.empty()) return result;

  const VertexErrors vertices = CompareVertices(track, source, truth, body, options);
  AddProjectionError(vertices.projection, options.image_side_px, &result);
  result.Add("pve_mm", vertices.position.mean * kMmPerMetre, "vertex error, pelvis aligned");

  const Motion& estimate = track.motion;
  const BodyModel& true_body = options.true_body != nullptr ? *options.true_body : body;
  const MatrixX3d rest = body.RestJoints(estimate.betas), true_rest = true_body.RestJoints(truth.motion.betas);
  std::vector<MatrixX3d> joints(T), true_joints(T);
  RowMatrixXd poses(T, estimate.poses.cols());
  for (int t = 0; t < T; ++t) {
    poses.row(t) = estimate.poses.row(source[t]);
    joints[t] = PosedJoints(body, rest, estimate, source[t]);
    true_joints[t] = PosedJoints(true_body, true_rest, truth.motion, t);
  }
  const MatrixX3d roots = RootPositions(joints, {0}), true_roots = RootPositions(true_joints, {0});
  const std::vector<MatrixX3d> relative = RelativeTo(joints, roots),
                               true_relative = RelativeTo(true_joints, true_roots);
  const double scale = ClipScale(relative, true_relative);
  const PositionError pa = ProcrustesPositionError(joints, true_joints);
  const PositionError mpjpe = MeanPositionError(relative, true_relative);
  result.Add("mpjpe_mm", mpjpe.mean * kMmPerMetre, "joint error, pelvis aligned");
  result.Add("mpjpe_scaled_mm", MeanPositionError(relative, true_relative, scale).mean * kMmPerMetre,
             "the same with one scale for the clip");
  result.Add("clip_scale", scale, "that scale: true size / estimated size");
  result.Add("pa_mpjpe_mm", pa.mean * kMmPerMetre, "joint error after one similarity a frame");
  result.Add("pa_p95_mm", pa.frames.p95 * kMmPerMetre, "95th percentile of frames");
  result.Add("pa_over_120_percent", PercentAbove(pa.of_frame, kAnotherPose_m), "frames in which it is above 120 mm");
  const MotionError acceleration = AccelerationError(joints, true_joints, truth.motion.timestamps);
  result.Add("accel_err_ms2", acceleration.mean, "acceleration error, m/s2");
  result.Add("gt_accel_ms2", acceleration.mean_truth, "true acceleration, m/s2");
  result.Add("jitter_ms3", Jitter(joints, truth.motion.timestamps), "mean jerk, m/s3");
  result.Add("gt_jitter_ms3", Jitter(true_joints, truth.motion.timestamps), "true mean jerk, m/s3");

  AddSigmaReliability(JudgedJoints(track, source, body, joints, true_joints), &result);

  const Eigen::Index columns = std::max(poses.cols(), truth.motion.poses.cols());
  const JointAngleError angles =
      MeanJointAngleError(WithColumns(poses, columns), WithColumns(truth.motion.poses, columns));
  result.Add("joint_angle_err_deg", angles.mean_deg, "rotation error of joints relative to their parents");
  result.Add("root_rotation_err_deg", angles.root_deg, "rotation error of the body in the camera frame");
  AddKneeFlexion(estimate, &truth.motion, &result);
  // A weak-perspective camera does not determine where the body stands.
  const bool has_depth = track.camera.model == CameraModel::kPinhole && truth.camera.model == CameraModel::kPinhole;
  const RootError root = has_depth ? RootPositionError(roots, true_roots) : RootError{};
  result.Add("root_err_mm", root.distance.mean * kMmPerMetre, "pelvis error");
  result.Add("root_lateral_err_mm", root.lateral * kMmPerMetre, "its part across the viewing direction");
  result.Add("root_depth_err_mm", root.depth * kMmPerMetre, "its part in depth");
  const MatrixX3d shape_difference = CentredShape(body, estimate.betas) - CentredShape(true_body, truth.motion.betas);
  result.Add("shape_err_mm", shape_difference.rowwise().norm().mean() * kMmPerMetre,
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
  breakdown("mpjpe_mm", mpjpe.per_point, kMmPerMetre);
  breakdown("joint_angle_err_deg", angles.per_joint_deg, 1);
  AddCoordinateErrors(track, source, truth, body, truth.world.value_or(track.world.value_or(WorldFrame())), &result);
  return result;
}

}  // namespace bodyloom
