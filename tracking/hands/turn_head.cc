// SPDX-License-Identifier: Apache-2.0
#include "tracking/hands/turn_head.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/check.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/procrustes.h"
#include "geometry/math/rotation.h"
#include "tracking/hands/put_parts.h"
#include "tracking/solvers/residuals/ceres_functions.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr int kNoseTip = 30;

const std::vector<std::string>& HeadLandmarks() {
  static const std::vector<std::string> names = {"nose", "left_eye", "right_eye"};
  return names;
}

/// Rows of the vertices that follow the head more than any other joint, at rest.
MatrixX3d HeadVertices(const BodyModel& body, const Eigen::VectorXd& betas, int head) {
  const MatrixX3d all = ShapeVertices(body, betas);
  std::vector<int> of_head;
  for (int v = 0; v < body.num_vertices(); ++v) {
    double weight = 0;
    for (int at = body.influence_begin()[size_t(v)]; at < body.influence_begin()[size_t(v) + 1]; ++at) {
      const auto& above = body.ancestors(body.influence_joint()[size_t(at)]);
      if (std::find(above.begin(), above.end(), head) != above.end()) weight += body.influence_weight()[size_t(at)];
    }
    if (weight > 0.5) of_head.push_back(v);
  }
  MatrixX3d vertices(Eigen::Index(of_head.size()), 3);
  for (size_t i = 0; i < of_head.size(); ++i) vertices.row(Eigen::Index(i)) = all.row(of_head[i]);
  return vertices;
}

/// The head's frames of a track, and their unknowns.
struct HeadFrames {
  std::vector<int> frames;
  std::vector<Matrix3d> head;  ///< local rotations by the body
  std::vector<Vector3d> turn;  ///< h
  std::vector<char> cut_before;
  std::vector<double> times_s;
};

}  // namespace

std::optional<Matrix3d> FaceFromHead(const BodyModel& body, const Eigen::VectorXd& betas) {
  const int head = body.FindJoint("head");
  for (const std::string& name : HeadLandmarks()) {
    if (head < 0 || body.FindLandmark(name) < 0) return std::nullopt;
  }
  BodyPose rest;
  rest.rotations.assign(size_t(body.num_joints()), Matrix3d::Identity());
  MatrixX3d of_face(3, 3);
  of_face << MeanFace().row(kNoseTip), MeanFace().middleRows(42, 6).colwise().mean(),
      MeanFace().middleRows(36, 6).colwise().mean();
  SimilarityTransform body_from_face =
      AlignPoints(of_face, PoseLandmarks(body, betas, rest, HeadLandmarks())).target_from_source;
  const MatrixX3d vertices = HeadVertices(body, betas, head);
  constexpr int kRounds = 20;
  MatrixX3d nearest(kFacePoints, 3);
  for (int round = 0; round < kRounds && vertices.rows() > 0; ++round) {
    const MatrixX3d face = body_from_face.Apply(MeanFace());
    for (int k = 0; k < kFacePoints; ++k) {
      Eigen::Index at = 0;
      (vertices.rowwise() - face.row(k)).rowwise().squaredNorm().minCoeff(&at);
      nearest.row(k) = vertices.row(at);
    }
    body_from_face = AlignPoints(MeanFace(), nearest).target_from_source;
  }
  return body_from_face.rotation.transpose();
}

bool HasDepth(const FaceObservation& face) {
  return std::any_of(face.depth_px.begin(), face.depth_px.end(), [](float depth) { return std::isfinite(depth); });
}

namespace {

/// S of a face without depth; none if too few points are known, or if the mean face does not lie on them.
std::optional<Matrix3d> RotationOfFlatFace(const FaceObservation& face) {
  constexpr int kJawPoints = 17, kRounds = 50;
  constexpr float kMinConfidence = 0.2F;
  constexpr double kFarthest = 0.2;  // root mean square, relative to the face's
  std::vector<int> known;
  for (int k = kJawPoints; k < kFacePoints; ++k) {
    const Keypoint& point = face.points[size_t(k)];
    if (point.confidence >= kMinConfidence && std::isfinite(point.x) && std::isfinite(point.y)) known.push_back(k);
  }
  const auto count = static_cast<Eigen::Index>(known.size());
  if (count < (kFacePoints - kJawPoints) / 2) return std::nullopt;
  MatrixX3d mean(count, 3), seen(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Keypoint& point = face.points[size_t(known[size_t(i)])];
    mean.row(i) = MeanFace().row(known[size_t(i)]);
    seen.row(i) << point.x, point.y, 0;
  }
  mean.rowwise() -= mean.colwise().mean().eval();
  seen.rowwise() -= seen.colwise().mean().eval();
  AlignmentResult aligned = AlignPoints(mean, seen);
  MatrixX3d laid;
  for (int round = 0; round < kRounds && aligned.status == AlignmentStatus::kUnique; ++round) {
    laid = mean * aligned.target_from_source.rotation.transpose();
    laid *= laid.leftCols<2>().cwiseProduct(seen.leftCols<2>()).sum() / laid.leftCols<2>().squaredNorm();
    seen.col(2) = laid.col(2);
    aligned = AlignPoints(mean, seen);
  }
  if (aligned.status != AlignmentStatus::kUnique) return std::nullopt;
  const double away = std::sqrt((laid - seen).squaredNorm() / laid.squaredNorm());
  return away < kFarthest ? std::optional(aligned.target_from_source.rotation) : std::nullopt;
}

}  // namespace

std::optional<Matrix3d> CameraFromFace(const FaceObservation& face, const Vector3d& ray) {
  if (!HasDepth(face)) {
    const std::optional<Matrix3d> flat = RotationOfFlatFace(face);
    return flat ? std::optional<Matrix3d>(RotationBetweenDirections(Vector3d::UnitZ(), ray) * *flat) : std::nullopt;
  }
  MatrixX3d seen(kFacePoints, 3);
  for (int k = 0; k < kFacePoints; ++k) {
    const Keypoint& point = face.points[size_t(k)];
    seen.row(k) << point.x, point.y, face.depth_px[size_t(k)];
    if (!(point.confidence > 0)) seen.row(k).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  const AlignmentResult aligned = AlignPoints(MeanFace(), seen);
  if (aligned.status != AlignmentStatus::kUnique || aligned.num_points < kFacePoints / 2) return std::nullopt;
  return RotationBetweenDirections(Vector3d::UnitZ(), ray) * aligned.target_from_source.rotation;
}

bool HeadTurnCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const Eigen::Map<const Vector3d> h(parameters[0]);
  const Vector3d off = AxisAngleFromRotation(off_ * RotationFromAxisAngle(h));
  Eigen::Map<Vector3d> r(residuals);
  r = off / sigma_;
  if (jacobians == nullptr || jacobians[0] == nullptr) return true;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> J(jacobians[0]);
  J = RightJacobianInverse(off) * RightJacobian(h) / sigma_;
  return true;
}

std::string WhyNoHead(const BodyModel& body, const HandsAndFaceSequence* seen) {
  if (seen == nullptr) return "no faces in the input";
  if (!FaceFromHead(body, {})) return "the body has no head with eyes and nose";
  bool any = false;
  for (const auto& frame : seen->frames) {
    if (frame == nullptr || !frame->face) continue;
    if (CameraFromFace(*frame->face, Vector3d::UnitZ())) return "";
    any = true;
  }
  return any ? "too few points of the faces are known, or they lie on no face" : "no face is seen";
}

PartFitSummary TurnHead(const BodyModel& body, const HandsAndFaceSequence& seen, const std::vector<char>& cut_before,
                        const HeadTurnOptions& options, Track* track) {
  BODYLOOM_CHECK(seen.num_frames() == track->num_frames(), "faces of ", seen.num_frames(), " frames, a track of ",
                 track->num_frames());
  PartFitSummary summary;
  summary.why = WhyNoHead(body, &seen);
  if (!summary.why.empty()) return summary;
  const int head = body.FindJoint("head");
  const Matrix3d face_from_head = FaceFromHead(body, track->motion.betas).value();
  const MatrixX3d rest = body.RestJoints(track->motion.betas);
  HeadFrames all;
  std::vector<std::optional<Matrix3d>> measured;
  std::vector<double> sigmas;
  std::vector<Matrix3d> camera_from_head;
  bool cut = true;
  for (int t = 0; t < track->num_frames(); ++t) {
    cut = cut || (!cut_before.empty() && cut_before[size_t(t)] != 0);
    if (!track->HasResult(t)) continue;
    const BodyPose pose = PoseFromAxisAngle(body, track->motion.poses.row(t), track->motion.trans.row(t));
    const PosedSkeleton skeleton = PoseSkeleton(body, rest, pose);
    Matrix3d G = skeleton.world_rotations[size_t(head)];
    Vector3d place = skeleton.joints.row(head);
    if (track->HasMovingCamera()) {
      const CameraPose& camera = track->camera_from_scene[size_t(t)];
      G = camera.camera_from_world_rotation * G;
      place = camera.camera_from_world_rotation * place + camera.camera_from_world_translation;
    }
    std::optional<Matrix3d> from_face;
    if (const auto& parts = seen.frames[size_t(t)]; parts != nullptr && parts->face) {
      const bool weak = track->camera.model == CameraModel::kWeakPerspective;
      from_face = CameraFromFace(*parts->face, weak ? Vector3d::UnitZ().eval() : place);
    }
    if (from_face) *from_face *= face_from_head;
    all.turn.emplace_back(from_face ? AxisAngleFromRotation(G.transpose() * *from_face) : Vector3d::Zero());
    all.frames.push_back(t);
    all.head.push_back(pose.rotations[size_t(head)]);
    all.cut_before.push_back(cut ? 1 : 0);
    all.times_s.push_back(track->motion.timestamps[size_t(t)]);
    measured.push_back(from_face);
    const bool flat = from_face && !HasDepth(*seen.frames[size_t(t)]->face);
    sigmas.push_back(flat ? options.flat_face_sigma : options.face_sigma);
    camera_from_head.push_back(G);
    cut = false;
  }
  ceres::Problem problem;
  std::vector<double*> blocks;
  for (Vector3d& turn : all.turn) blocks.push_back(turn.data());
  AddSteadyPrior(options.head, blocks, 3, all.times_s, all.cut_before, &problem);
  for (size_t i = 0; i < all.frames.size(); ++i) {
    if (!measured[i]) continue;
    ++summary.frames_seen;
    const double weight = IndependentShare(i, all.times_s, all.cut_before, options.errors_last_s);
    problem.AddResidualBlock(new HeadTurnCost(*measured[i], camera_from_head[i], sigmas[i]),
                             new ceres::ScaledLoss(new GemanMcClureLoss(options.kernel), weight, ceres::TAKE_OWNERSHIP),
                             blocks[i]);
  }
  summary.why = Concatenate("face seen in ", summary.frames_seen, " of ", track->num_frames(), " frames");
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.num_threads = 1;  // as of hands
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary solved;
  ceres::Solve(solver, &problem, &solved);
  summary.iterations = static_cast<int>(solved.iterations.size()) - 1;
  summary.ran = solved.IsSolutionUsable();
  if (!summary.ran) {
    summary.why = "Ceres: " + solved.message;
    return summary;
  }
  const PartOfTrack part = PartOfHead(body, *track);
  for (size_t i = 0; i < all.frames.size(); ++i) {
    const int t = all.frames[i];
    BodyPose pose = PoseFromAxisAngle(body, track->motion.poses.row(t), track->motion.trans.row(t));
    pose.rotations[size_t(head)] = all.head[i] * RotationFromAxisAngle(all.turn[i]);
    PutPart(body, rest, pose, part, t, track);
  }
  return summary;
}

}  // namespace bodyloom
