// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/evaluation/pseudo_truth.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "bodyloom/data_tools/evaluation/metrics.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/camera_path.h"
#include "bodyloom/geometry/posed_body.h"
#include "bodyloom/geometry/rotation.h"

namespace bodyloom {
namespace {

constexpr double kLandmarkSigma_m = 0.02;
constexpr int kShapeFrames = 60;  // spread over the clip: more say the same about a shape

MatrixX3d Centred(const MatrixX3d& points) { return points.rowwise() - points.colwise().mean(); }

/// Frame t's pose in the camera frame, at the place where the body's own origin is its root's turning point.
BodyPose InCamera(const BodyModel& body, const Motion& motion, int t, const CameraPose& camera) {
  BodyPose pose = PoseFromAxisAngle(body, motion.poses.row(t).transpose(), Eigen::Vector3d::Zero());
  pose.rotations[0] = camera.camera_from_world_rotation * pose.rotations[0];
  return pose;
}

MatrixX3d Cocos(const BodyModel& body, const Eigen::VectorXd& betas, const BodyPose& pose) {
  return PoseLandmarks(body, betas, pose, CocoNames());
}

/// The shape of the formula in the header: the places are eliminated by centring.
Eigen::VectorXd FitShape(const BodyModel& body, const std::vector<BodyPose>& poses,
                         const std::vector<MatrixX3d>& landmarks) {
  const int B = body.num_betas(), T = static_cast<int>(poses.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(B, B);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(B);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(B);
  std::vector<int> seen;
  for (int t = 0; t < T; ++t) {
    if (landmarks[t].allFinite()) seen.push_back(t);
  }
  BODYLOOM_CHECK(!seen.empty(), "MakePseudoTruth: the clip has no frame whose landmarks are all known");
  const int n = std::min<int>(kShapeFrames, static_cast<int>(seen.size()));
  const double weight = 1 / (n * kLandmarkSigma_m * kLandmarkSigma_m);
  for (int i = 0; i < n; ++i) {
    const int t = seen[seen.size() * i / n];
    const MatrixX3d mean = Centred(Cocos(body, zero, poses[t]));
    const MatrixX3d missing = Centred(landmarks[t]) - mean;
    Eigen::MatrixXd J(missing.size(), B);
    for (int k = 0; k < B; ++k) {
      const MatrixX3d column = Centred(Cocos(body, Eigen::VectorXd::Unit(B, k), poses[t])) - mean;
      J.col(k) = Eigen::Map<const Eigen::VectorXd>(column.data(), column.size());
    }
    A += weight * J.transpose() * J;
    b += weight * J.transpose() * Eigen::Map<const Eigen::VectorXd>(missing.data(), missing.size());
  }
  return A.ldlt().solve(b);
}

}  // namespace

PseudoTruth MakePseudoTruth(const MultiViewClip& clip, const RigView& view, const BodyModel& body,
                            PseudoTruthShape shape) {
  const int T = std::min(clip.motion.num_frames(), static_cast<int>(clip.coco17_in_world.size()));
  BODYLOOM_CHECK(T > 0, "MakePseudoTruth: the clip '", clip.name, "' has no motion");
  // As published the unit of length is the body's: the same pixels come from a camera as much nearer.
  const bool published = shape == PseudoTruthShape::kAsPublished;
  const double unit = published ? clip.motion_scale : 1;
  std::vector<BodyPose> poses(T);
  std::vector<MatrixX3d> landmarks(T);
  for (int t = 0; t < T; ++t) {
    poses[t] = InCamera(body, clip.motion, t, view.pose);
    landmarks[t] = MovedPoints(view.pose, clip.coco17_in_world[t]) / unit;
  }
  PseudoTruth result;
  Motion& motion = result.track.motion;
  motion.body = clip.motion.body;
  motion.up = Motion::Up::kCamera;
  motion.betas = published ? Eigen::VectorXd::Zero(body.num_betas()) : FitShape(body, poses, landmarks);
  motion.poses.resize(T, 3 * static_cast<Eigen::Index>(body.num_joints()));
  motion.trans.resize(T, 3);
  const Eigen::Vector3d pelvis = body.RestJoints(motion.betas).row(0).transpose();
  PositionErrorAccumulator error;
  for (int t = 0; t < T; ++t) {
    const MatrixX3d here = Cocos(body, motion.betas, poses[t]);
    if (published) {
      // Where the root joint is in the world, seen from the camera.
      const Eigen::Vector3d root = pelvis + clip.motion.trans.row(t).transpose();
      poses[t].trans =
          view.pose.camera_from_world_rotation * root + view.pose.camera_from_world_translation / unit - pelvis;
    } else {
      poses[t].trans = (landmarks[t] - here).colwise().mean().transpose();
    }
    motion.poses.row(t) = AxisAngleFromPose(body, poses[t]).transpose();
    motion.trans.row(t) = poses[t].trans.transpose();
    error.AddFrame(unit * ((here.rowwise() + poses[t].trans.transpose()) - landmarks[t]).rowwise().norm());
    motion.timestamps.push_back(t / clip.fps);
  }
  const PositionError distances = error.Result();
  result.landmark_error_m = distances.mean;
  result.landmark_error_p95_m = distances.frames.p95;
  result.track.camera = view.camera;
  result.track.frame_status.assign(T, FrameStatus::kTracked);
  return result;
}

}  // namespace bodyloom
