// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/initial_states.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "tracking/initialise/inverse_kinematics.h"
#include "tracking/initialise/joint_hypotheses.h"
#include "tracking/initialise/lifted_landmarks.h"
#include "tracking/initialise/lifted_start.h"
#include "tracking/initialise/swap_repair.h"
#include "tracking/problem/input_checks.h"
#include "tracking/problem/sequence_problem.h"
#include "tracking/problem/stature.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// Fills all frames from states at `frames` (ascending): SO(3) interpolation between, constant beyond the ends and from
/// a cut to the nearest of `frames` on the same side of it.
std::vector<FrameState> FillFrames(const std::vector<int>& frames, const std::vector<FrameState>& known,
                                   const std::vector<double>& timestamps, const std::vector<char>& cut_before) {
  const std::vector<int> shot = ShotOfFrames(cut_before);
  std::vector<FrameState> states(timestamps.size());
  size_t next = 0;
  for (size_t t = 0; t < timestamps.size(); ++t) {
    while (next < frames.size() && frames[next] < static_cast<int>(t)) ++next;
    const bool has_previous = next > 0, has_next = next < frames.size();
    const bool same_previous = has_previous && shot[frames[next - 1]] == shot[t];
    const bool same_next = has_next && shot[frames[next]] == shot[t];
    if (has_previous && has_next && same_previous == same_next) {
      const double t0 = timestamps[frames[next - 1]], t1 = timestamps[frames[next]];
      states[t] = InterpolateStates(known[next - 1], known[next], (timestamps[t] - t0) / (t1 - t0));
    } else {
      states[t] = same_next || !has_previous ? known[next] : known[next - 1];
    }
  }
  return states;
}

/// Hypotheses for every shot separately, since frames beyond a cut do not constrain depth, heading or limbs. For a shot
/// that never shows both shoulders and both hips well, joints of low confidence are used first, then an occluded
/// shoulder or hip is placed at its partner.
JointHypothesesResult FindHypothesesOfShots(const KeypointSequence& keypoints, const std::vector<char>& cut_before,
                                            const Camera& camera, const MatrixX3d& rest_points, const PosePrior* prior,
                                            const JointHypothesesOptions& options) {
  JointHypothesesResult all;
  const int T = keypoints.num_frames();
  for (int first = 0, end = 0; first < T; first = end) {
    for (end = first + 1; end < T && cut_before[end] == 0;) ++end;
    const auto K = static_cast<std::ptrdiff_t>(keypoints.names.size());
    KeypointSequence shot;
    shot.names = keypoints.names;
    shot.points.assign(keypoints.points.begin() + first * K, keypoints.points.begin() + end * K);
    shot.timestamps.assign(keypoints.timestamps.begin() + first, keypoints.timestamps.begin() + end);
    JointHypothesesOptions hypotheses = options;
    JointHypothesesResult found = FindJointHypotheses(shot, camera, rest_points, prior, hypotheses);
    if (found.frames.empty()) {
      hypotheses.confidence = std::min(hypotheses.confidence, 0.02);
      found = FindJointHypotheses(shot, camera, rest_points, prior, hypotheses);
    }
    if (found.frames.empty()) {
      hypotheses.hidden_pairs = true;
      found = FindJointHypotheses(shot, camera, rest_points, prior, hypotheses);
    }
    all.cost += found.cost;
    for (size_t i = 0; i < found.frames.size(); ++i) {
      all.frames.push_back(first + found.frames[i]);
      all.hypotheses.push_back(std::move(found.hypotheses[i]));
    }
  }
  return all;
}

MatrixX3d RestLandmarks(const BodyModel& model, const VectorXd& betas = VectorXd()) {
  BodyPose rest;
  rest.rotations.assign(model.num_joints(), Matrix3d::Identity());
  return PoseLandmarks(model, betas, rest, CocoNames());
}

/// Replaces translations by weak-perspective cameras fitted to the frame's observations; frames with too few take their
/// neighbour's.
void ToWeakPerspective(const KeypointSequence& keypoints, const FrameLayout& layout, std::vector<FrameState>* states) {
  Vector3d last(0, 0, 0);
  bool known = false;
  for (size_t t = 0; t < states->size(); ++t) {
    FrameState& state = (*states)[t];
    BodyPose pose{state.rotations, Vector3d::Zero()};
    std::vector<Vector3d> points;
    std::vector<Vector2d> pixels;
    const MatrixX3d landmarks = PoseLandmarks(*layout.model, VectorXd(), pose, CocoNames());
    for (int k = 0; k < 17; ++k) {
      const auto it = std::find(keypoints.names.begin(), keypoints.names.end(), CocoNames()[k]);
      if (it == keypoints.names.end()) continue;
      const Keypoint& point = keypoints.at(static_cast<int>(t), static_cast<int>(it - keypoints.names.begin()));
      if (point.confidence < 0.2F) continue;
      points.push_back(landmarks.row(k).transpose());
      pixels.emplace_back(point.x, point.y);
    }
    Vector3d weak;
    if (points.size() >= 4 && FitWeakCamera(points, pixels, layout.camera.cx, layout.camera.cy, &weak)) {
      if (!known) {
        for (size_t u = 0; u < t; ++u) (*states)[u].translation = weak;
      }
      last = weak;
      known = true;
    }
    state.translation = last;
  }
}

/// Hypotheses need rays. For weak perspective the camera keeps the focal length it would have had as a pinhole.
Camera CameraOfRays(const FrameLayout& layout) {
  Camera camera = layout.camera;
  camera.model = CameraModel::kPinhole;
  return camera;
}

/// The joints as the scene's camera sees them; `path` turns in place. None where it looks too far away from them.
std::optional<KeypointSequence> SeenFromScene(const KeypointSequence& keypoints, const Camera& camera,
                                              const std::vector<CameraPose>& path) {
  const double farthest = std::cos(M_PI / 4);
  for (const CameraPose& pose : path) {
    if (!pose.camera_from_world_translation.isZero() || pose.camera_from_world_rotation(2, 2) < farthest) return {};
  }
  KeypointSequence turned = keypoints;
  const size_t joints = keypoints.names.size();
  for (size_t i = 0; i < turned.points.size(); ++i) {
    Keypoint& point = turned.points[i];
    const Vector3d ray = camera.Unproject({point.x, point.y}).homogeneous();
    Vector2d pixel = Vector2d::Zero();
    if (!camera.Project(path[i / joints].camera_from_world_rotation.transpose() * ray, &pixel)) point.confidence = 0;
    point.x = static_cast<float>(pixel.x());
    point.y = static_cast<float>(pixel.y());
  }
  return turned;
}

/// The network reads how the person moves over the picture as from a camera that stands still. So behind one that turns
/// it reads the joints as the scene's camera sees them, and its landmarks are turned back.
std::vector<LiftedFrame> LiftedFrames(const TrackSequenceInput& input, const KeypointSequence& keypoints,
                                      const FrameLayout& layout, const TrackSequenceOptions& options) {
  if (input.lifted != nullptr) return *input.lifted;
  LiftOptions lift;
  lift.num_threads = ThreadsFor(options.num_threads);
  const Camera camera = CameraOfRays(layout);
  std::optional<KeypointSequence> from_scene;
  if (input.camera_from_scene != nullptr) from_scene = SeenFromScene(keypoints, camera, *input.camera_from_scene);
  std::vector<LiftedFrame> lifted =
      LiftKeypoints(from_scene ? *from_scene : keypoints, camera, layout.knowledge == CameraKnowledge::kKnown,
                    FindCuts(keypoints), *input.lifter, lift);
  for (size_t t = 0; from_scene && t < lifted.size(); ++t) {
    const Matrix3d& R = (*input.camera_from_scene)[t].camera_from_world_rotation;
    TurnLandmarks(R, &lifted[t]);
    lifted[t].up = R * lifted[t].up;
    lifted[t].camera_from_virtual = R * lifted[t].camera_from_virtual;
  }
  return lifted;
}

/// The frames that the initialiser has, and the others between them.
void StartFromInitialiser(const TrackSequenceInput& input, const KeypointSequence* keypoints, InitialStates* result) {
  const Motion& initialiser = *input.initialiser;
  const int T = initialiser.num_frames();
  std::vector<int> frames;
  std::vector<FrameState> known;
  result->from_observation.assign(T, 0);
  for (int t = 0; t < T; ++t) {
    if (!initialiser.HasPose(t)) continue;
    const BodyPose pose =
        PoseFromAxisAngle(*input.body, initialiser.poses.row(t).transpose(), initialiser.trans.row(t).transpose());
    frames.push_back(t);
    known.push_back({pose.rotations, pose.trans});
    result->from_observation[t] = 1;
  }
  result->states = FillFrames(frames, known, *ExtentOf(input).timestamps,
                              keypoints != nullptr ? FindCuts(*keypoints) : std::vector<char>(T, 0));
}

}  // namespace

bool FitWeakCamera(const std::vector<Vector3d>& points, const std::vector<Vector2d>& pixels, double cx, double cy,
                   Vector3d* log_scale_tx_ty) {
  BODYLOOM_CHECK(points.size() == pixels.size(), "weak camera: ", points.size(), " points and ", pixels.size(),
                 " pixels");
  if (points.size() < 2) return false;
  Vector2d mean_point = Vector2d::Zero(), mean_pixel = Vector2d::Zero();
  for (size_t i = 0; i < points.size(); ++i) {
    mean_point += points[i].head<2>() / static_cast<double>(points.size());
    mean_pixel += pixels[i] / static_cast<double>(points.size());
  }
  double dot = 0, square = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    dot += (points[i].head<2>() - mean_point).dot(pixels[i] - mean_pixel);
    square += (points[i].head<2>() - mean_point).squaredNorm();
  }
  const double scale = dot / square;
  if (!(scale > 0) || !std::isfinite(scale)) return false;
  *log_scale_tx_ty = {std::log(scale), (mean_pixel.x() - cx) / scale - mean_point.x(),
                      (mean_pixel.y() - cy) / scale - mean_point.y()};
  return true;
}

KeypointSequence JointsFromDense(const BodyModel& model, const DenseSequence& dense) {
  const MatrixX3d landmarks = RestLandmarks(model);
  const MatrixX3d& vertices = model.data().v_template;
  RowMatrixXf closeness(vertices.rows(), 17);
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    for (int k = 0; k < 17; ++k) {
      const double d2 = (vertices.row(v) - landmarks.row(k)).squaredNorm();
      closeness(v, k) = static_cast<float>(std::exp(-d2 / (2 * 0.06 * 0.06)));
    }
  }
  KeypointSequence result;
  result.convention = "coco17 from dense keypoints";
  result.names = CocoNames();
  result.timestamps = dense.timestamps;
  result.image_width = dense.image_width;
  result.image_height = dense.image_height;
  result.points.resize(17 * dense.frames.size());
  for (int t = 0; t < dense.num_frames(); ++t) {
    Eigen::Matrix<double, 17, 3> sums = Eigen::Matrix<double, 17, 3>::Zero();
    for (const DenseKeypoint& point : dense.frames[t]) {
      for (int k = 0; k < 17; ++k) {
        double w = 0;
        for (int c = 0; c < 3; ++c) w += point.barycentric[c] * closeness(model.data().faces(point.face, c), k);
        sums.row(k) += w * Eigen::RowVector3d(point.pixel.x(), point.pixel.y(), 1);
      }
    }
    const double total = std::max<double>(1, static_cast<double>(dense.frames[t].size()));
    for (int k = 0; k < 17; ++k) {
      // A landmark in plain sight gathers about 2 % of the surface points.
      const double confidence = std::min(0.9, sums(k, 2) / (0.01 * total));
      if (sums(k, 2) > 0.1) {
        result.at(t, k) = {static_cast<float>(sums(k, 0) / sums(k, 2)), static_cast<float>(sums(k, 1) / sums(k, 2)),
                           static_cast<float>(confidence)};
      }
    }
  }
  return result;
}

const KeypointSequence* JointsToStartFrom(const TrackSequenceInput& input, KeypointSequence* from_dense) {
  if (input.keypoints != nullptr || input.dense == nullptr) return input.keypoints;
  *from_dense = JointsFromDense(*input.body, *input.dense);
  return from_dense;
}

std::string WhyNoLifter(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  return input.initialiser != nullptr ? "an initialiser was given" : WhyNotLifted(input, options);
}

std::string WhyNotLifted(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  if (input.lifter == nullptr) return "no lifter was given";
  if (input.keypoints == nullptr && input.dense == nullptr) return "it reads 2D joints, and there are none";
  if (options.lifter_weight == 0) return "switched off";
  if (!CompileLiftedLandmarks(*input.body, 0).IsUsable()) return "the body lacks its landmarks";
  return "";
}

InitialStates FindInitialStates(const TrackSequenceInput& input, const KeypointSequence* keypoints,
                                const FrameLayout& layout, const TrackSequenceOptions& options, LiftedStart* lifted) {
  const BodyModel& model = *input.body;
  InitialStates result;
  result.betas = VectorXd::Zero(layout.num_betas);
  if (input.initialiser != nullptr) {
    const Eigen::Index given = std::min<Eigen::Index>(input.initialiser->betas.size(), layout.num_betas);
    result.betas.head(given) = input.initialiser->betas.head(given);
    if (input.stature_m > 0) result.betas = WithStature(model, result.betas, input.stature_m);
    StartFromInitialiser(input, keypoints, &result);
    const bool wants_ground = options.ground.use_up || options.ground.contact_weight > 0;
    if (lifted != nullptr && keypoints != nullptr && wants_ground && WhyNotLifted(input, options).empty()) {
      lifted->frames = LiftedFrames(input, *keypoints, layout, options);
    }
  } else {
    const Camera camera = CameraOfRays(layout);
    if (layout.num_betas > 0) {
      result.betas = EstimateShape(*keypoints, camera, model, layout.num_betas, options.hypotheses);
      if (input.stature_m > 0) result.betas = WithStature(model, result.betas, input.stature_m);
    }
    if (WhyNoLifter(input, options).empty()) {
      LiftedStart start;
      start.frames = LiftedFrames(input, *keypoints, layout, options);
      StartFromLifted(*keypoints, camera, model, result.betas, &start);
      if (!start.frames.empty()) {
        result = std::move(start.initial);
        if (lifted != nullptr) *lifted = std::move(start);
        if (layout.knowledge == CameraKnowledge::kWeak) ToWeakPerspective(*keypoints, layout, &result.states);
        return result;
      }
    }
    const MatrixX3d rest_joints = model.RestJoints(result.betas), rest_points = RestLandmarks(model, result.betas);
    const std::vector<char> cuts = FindCuts(*keypoints);
    const JointHypothesesResult found =
        FindHypothesesOfShots(*keypoints, cuts, camera, rest_points, input.prior, options.hypotheses);
    if (found.frames.empty()) return result;
    std::vector<FrameState> known;
    result.from_observation.assign(keypoints->num_frames(), 0);
    for (size_t i = 0; i < found.frames.size(); ++i) {
      const JointHypothesis& hypothesis = found.hypotheses[i];
      const BodyPose pose =
          PoseFromJoints(model, rest_joints, rest_points, hypothesis.points, hypothesis.torso_rotation);
      known.push_back({pose.rotations, pose.trans});
      result.from_observation[found.frames[i]] = 1;
    }
    result.cost = found.cost;
    result.states = FillFrames(found.frames, known, keypoints->timestamps, cuts);
  }
  if (layout.knowledge == CameraKnowledge::kWeak) ToWeakPerspective(*keypoints, layout, &result.states);
  return result;
}

}  // namespace bodyloom
