// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/aist_evaluation.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "data_tools/evaluation/joint_angle_errors.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/evaluation/vertex_errors.h"
#include "data_tools/formats/pickle.h"
#include "data_tools/motion/motion_readers.h"
#include "data_tools/observations/detection_readers.h"
#include "data_tools/observations/load_cameras.h"
#include "geometry/base/check.h"
#include "geometry/base/units.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"

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
  // Published translations are in the template's size, the track's in its own: lengths are not comparable.
  if (!smpl) {
    result->Add("pve_mm", errors.position.mean * kMmPerMetre, "vertex error, pelvis aligned");
  }
  const bool has_vertical = !clip.up_in_world.isZero();
  const WorldFrame world =
      has_vertical ? WorldOverGround(own->pose.camera_from_world_rotation * clip.up_in_world, 0) : WorldFrame();
  AddCoordinateErrors(track, source, truth.track, body, world, result);
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
  clip.up_in_world = Eigen::Vector3d::UnitY();
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

namespace {

constexpr double kLandmarkSigma_m = 0.02;
constexpr int kShapeFrames = 60;  // spread over the clip: more add nothing about the shape

MatrixX3d Centred(const MatrixX3d& points) { return points.rowwise() - points.colwise().mean(); }

/// Frame t's pose in the camera frame, translated for a body whose root rotates about the origin.
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
  // As published the unit of length is the body's, so the camera is nearer by the same factor.
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
      // Position of the root joint in the world, in camera coordinates.
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
