// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/vertex_errors.h"

#include <algorithm>
#include <string>

#include "geometry/base/check.h"
#include "geometry/base/units.h"
#include "geometry/body/posed_body.h"
#include "geometry/body/skinning.h"

namespace bodyloom {
namespace {

constexpr int kFramesHeld = 64;  // whose vertices are held at a time

BodyPose PoseOf(const BodyModel& body, const Motion& motion, int t) {
  return PoseFromAxisAngle(body, motion.poses.row(t).transpose(), motion.trans.row(t).transpose());
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

}  // namespace

VertexErrors CompareVertices(const Track& track, const std::vector<int>& source, const Track& truth,
                             const BodyModel& body, const VertexErrorOptions& options) {
  const int T = static_cast<int>(source.size());
  BODYLOOM_CHECK(T <= truth.num_frames(), "CompareVertices: ", T, " frames, the truth has ", truth.num_frames());
  BODYLOOM_CHECK(options.vertex_step >= 1, "CompareVertices: vertex_step ", options.vertex_step, " must be positive");
  SkinnerOptions skinning;
  skinning.num_threads = options.num_threads;
  for (int v = 0; v < body.num_vertices(); v += options.vertex_step) skinning.vertices.push_back(v);
  const BodyModel& true_body = options.true_body != nullptr ? *options.true_body : body;
  BODYLOOM_CHECK(true_body.num_vertices() == body.num_vertices() && true_body.num_joints() == body.num_joints(),
                 "CompareVertices: the true body has ", true_body.num_vertices(), " vertices and ",
                 true_body.num_joints(), " joints, expected ", body.num_vertices(), " and ", body.num_joints());
  const Skinner skinner(body, skinning), true_skinner(true_body, skinning);
  const ShapedBody shaped = skinner.Shape(track.motion.betas), true_shaped = true_skinner.Shape(truth.motion.betas);

  ProjectionErrorAccumulator projection(
      SquareImageScale(truth.camera.width, truth.camera.height, options.image_side_px));
  PositionErrorAccumulator position;
  for (int begin = 0; begin < T; begin += kFramesHeld) {
    const int end = std::min(T, begin + kFramesHeld);
    std::vector<BodyPose> own, true_own;
    std::vector<Eigen::RowVector3d> pelvis_offset;
    for (int t = begin; t < end; ++t) {
      BODYLOOM_CHECK(source[t] >= 0 && source[t] < track.num_frames(), "CompareVertices: no frame ", source[t]);
      own.push_back(PoseOf(body, track.motion, source[t]));
      true_own.push_back(PoseOf(true_body, truth.motion, t));
      pelvis_offset.emplace_back(PoseSkeleton(body, shaped.rest_joints, own.back()).joints.row(0) -
                                 PoseSkeleton(true_body, true_shaped.rest_joints, true_own.back()).joints.row(0));
    }
    const std::vector<MatrixX3d> vertices = SkinFrames(skinner, shaped, own);
    const std::vector<MatrixX3d> true_vertices = SkinFrames(true_skinner, true_shaped, true_own);
    for (int t = begin; t < end; ++t) {
      const MatrixX3d &a = vertices[t - begin], &b = true_vertices[t - begin];
      projection.AddFrame(ProjectPoints(track.CameraAt(source[t]), a), ProjectPoints(truth.CameraAt(t), b));
      position.AddFrame(((a - b).rowwise() - pelvis_offset[t - begin]).rowwise().norm());
    }
  }
  return {projection.Result(), position.Result()};
}

Eigen::VectorXd VertexErrorsOfFrame(const Track& track, const Track& truth, int t, const BodyModel& body,
                                    VertexErrorUnit unit, const VertexErrorOptions& options) {
  BODYLOOM_CHECK(t >= 0 && t < track.num_frames() && t < truth.num_frames(), "VertexErrorsOfFrame: no frame ", t);
  if (!track.HasResult(t) || !truth.HasResult(t)) return {};
  const BodyPose own = PoseOf(body, track.motion, t), true_own = PoseOf(body, truth.motion, t);
  const MatrixX3d vertices = PoseVertices(body, track.motion.betas, own);
  const MatrixX3d true_vertices = PoseVertices(body, truth.motion.betas, true_own);
  if (unit == VertexErrorUnit::kPixels) {
    const double scale = SquareImageScale(truth.camera.width, truth.camera.height, options.image_side_px);
    return scale * (ProjectPoints(track.CameraAt(t), vertices) - ProjectPoints(truth.CameraAt(t), true_vertices))
                       .rowwise()
                       .norm();
  }
  const auto pelvis = [&](const Eigen::VectorXd& betas, const BodyPose& pose) -> Eigen::RowVector3d {
    return PoseSkeleton(body, body.RestJoints(betas), pose).joints.row(0);
  };
  const Eigen::RowVector3d offset = pelvis(track.motion.betas, own) - pelvis(truth.motion.betas, true_own);
  return kMmPerMetre * ((vertices - true_vertices).rowwise() - offset).rowwise().norm();
}

void AddProjectionError(const ProjectionError& error, int image_side_px, Evaluation* evaluation) {
  evaluation->Add("projection_mean_px", error.mean_px,
                  "per-vertex projection error in an image of " + std::to_string(image_side_px) + " px");
  evaluation->Add("projection_std_px", error.std_frames_px, "its standard deviation over frames' means");
  evaluation->Add("projection_std_vertices_px", error.std_vertices_px, "and over all frames and vertices");
  evaluation->Add("projection_rms_px", error.rms_px, "its root mean square");
  evaluation->Add("projection_p95_px", error.frames_px.p95, "95th percentile of frames' means");
}

}  // namespace bodyloom
