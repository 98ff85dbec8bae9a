// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/lifted_start.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "tracking/initialise/inverse_kinematics.h"
#include "tracking/initialise/joint_hypotheses.h"
#include "tracking/lifter/lifter_input.h"
#include "tracking/problem/robust.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kRayKernel = 0.15;  ///< kernel of a landmark's distance from its ray, metres
constexpr double kNearest = 0.3;     ///< metres; a person nearer than that is a failed estimate
constexpr double kMinLiftConfidence = 0.1;

struct Sight {
  int landmark;
  Vector3d ray;  ///< unit
  double weight;
};

/// Position of the mid-hip from the rays of one frame.
std::optional<Vector3d> PlaceOnRays(const std::vector<Sight>& sights, const MatrixX3d& offsets) {
  if (sights.size() < 3) return std::nullopt;
  Vector3d hips = Vector3d::Zero();
  for (int pass = 0; pass < 4; ++pass) {
    Matrix3d A = Matrix3d::Zero();
    Vector3d b = Vector3d::Zero();
    for (const Sight& sight : sights) {
      const Matrix3d across = Matrix3d::Identity() - sight.ray * sight.ray.transpose();
      const Vector3d x = offsets.row(sight.landmark).transpose();
      double weight = sight.weight;
      if (pass > 0) weight *= GemanMcClure((across * (x + hips)).squaredNorm() / (kRayKernel * kRayKernel), 1).weight;
      A += weight * across;
      b -= weight * across * x;
    }
    const Eigen::LDLT<Matrix3d> solver(A);
    // Rays that are nearly parallel do not determine the depth.
    if (solver.info() != Eigen::Success || !(solver.vectorD().minCoeff() > 1e-6 * solver.vectorD().maxCoeff())) {
      return std::nullopt;
    }
    hips = solver.solve(b);
  }
  // The network's own hips need not lie at its origin.
  const double hip_z = 0.5 * (offsets(kLifterLeftHip, 2) + offsets(kLifterLeftHip + 1, 2));
  if (!hips.allFinite() || std::min(hips.z(), hips.z() + hip_z) < kNearest) return std::nullopt;
  return hips;
}

std::vector<Sight> SightsOf(const KeypointSequence& keypoints, const std::array<int, kLifterPoints>& columns,
                            const Camera& camera, int t) {
  std::vector<Sight> sights;
  for (int k = 0; k < kLifterPoints; ++k) {
    if (columns[k] < 0) continue;
    const Keypoint& point = keypoints.at(t, columns[k]);
    if (!(point.confidence >= kMinLiftConfidence) || !std::isfinite(point.x) || !std::isfinite(point.y)) continue;
    const Eigen::Vector2d ray = camera.Unproject({point.x, point.y});
    if (!ray.allFinite()) continue;
    const double c = std::min(1.0F, point.confidence);
    sights.push_back({k, Vector3d(ray.x(), ray.y(), 1).normalized(), c * c});
  }
  return sights;
}

/// Positions of frames that have none: between their neighbours', constant beyond the ends. False when none is known.
bool FillPositions(const std::vector<double>& timestamps, std::vector<std::optional<Vector3d>>* positions) {
  const int T = static_cast<int>(positions->size());
  int last = -1;
  for (int t = 0; t <= T; ++t) {
    if (t < T && !(*positions)[t]) continue;
    if (t == T && last < 0) return false;
    for (int gap = last + 1; gap < t; ++gap) {
      if (last < 0 || t == T) {
        (*positions)[gap] = (*positions)[last < 0 ? t : last];
      } else {
        const double s = (timestamps[gap] - timestamps[last]) / (timestamps[t] - timestamps[last]);
        (*positions)[gap] = (1 - s) * *(*positions)[last] + s * *(*positions)[t];
      }
    }
    last = t;
  }
  return true;
}

}  // namespace

double LifterMetres(const BodyModel& body, const Eigen::VectorXd& betas) {
  BodyPose rest;
  rest.rotations.assign(body.num_joints(), Matrix3d::Identity());
  const MatrixX3d points = PoseLandmarks(body, betas, rest, CocoNames());
  std::vector<float> measured(3 * kLifterPoints, 0);
  for (int k = 0; k < 17; ++k) {
    for (int c = 0; c < 3; ++c) measured[3 * k + c] = static_cast<float>(points(k, c));
  }
  return LifterReferenceLength(measured);
}

std::vector<FrameState> PosesFromLifted(const std::vector<LiftedFrame>& frames, const KeypointSequence& keypoints,
                                        const Camera& camera, const BodyModel& body, const Eigen::VectorXd& betas,
                                        double metres) {
  BodyPose rest;
  rest.rotations.assign(body.num_joints(), Matrix3d::Identity());
  const MatrixX3d rest_joints = body.RestJoints(betas), rest_points = PoseLandmarks(body, betas, rest, CocoNames());
  std::array<int, kLifterPoints> columns;
  for (int k = 0; k < kLifterPoints; ++k) {
    const auto it = std::find(keypoints.names.begin(), keypoints.names.end(), LifterPointNames()[k]);
    columns[k] = it == keypoints.names.end() ? -1 : static_cast<int>(it - keypoints.names.begin());
  }
  const int T = keypoints.num_frames();
  std::vector<std::optional<Vector3d>> hips(T);
  for (int t = 0; t < T; ++t) {
    hips[t] = PlaceOnRays(SightsOf(keypoints, columns, camera, t), metres * frames[t].points);
  }
  std::vector<FrameState> states;
  if (!FillPositions(keypoints.timestamps, &hips)) return states;
  Matrix3d torso = Matrix3d::Identity();
  for (int t = 0; t < T; ++t) {
    const MatrixX3d points = (metres * frames[t].points.topRows(17)).rowwise() + hips[t]->transpose();
    TorsoFrame(points, &torso);  // a degenerate torso keeps its predecessor's axes
    const BodyPose pose = PoseFromJoints(body, rest_joints, rest_points, points, torso);
    states.push_back({pose.rotations, pose.trans});
  }
  return states;
}

void StartFromLifted(const KeypointSequence& keypoints, const Camera& camera, const BodyModel& body,
                     const Eigen::VectorXd& betas, LiftedStart* start) {
  if (start->frames.empty()) return;
  start->metres = LifterMetres(body, betas);
  start->initial.states = PosesFromLifted(start->frames, keypoints, camera, body, betas, start->metres);
  if (start->initial.states.empty()) {
    start->frames.clear();
    return;
  }
  for (const LiftedFrame& frame : start->frames) start->initial.from_observation.push_back(frame.seen);
  start->initial.betas = betas;
}

}  // namespace bodyloom
