// SPDX-License-Identifier: Apache-2.0
#include "tracking/clip/initialiser_gain.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "geometry/base/units.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "tracking/initialise/lifted_landmarks.h"
#include "tracking/lifter/lifter_input.h"
#include "tracking/problem/body_points.h"
#include "tracking/terms/landmarks.h"

namespace bodyloom {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr float kShownConfidence = 0.3F;

MedianAndP95 Summarise(const std::vector<double>& values) {
  const std::vector<double> sorted = SortedFinite(values);
  return {SortedPercentile(sorted, 50), SortedPercentile(sorted, 95)};
}

/// The first betas, as many as the body and the compiled landmarks have.
Eigen::VectorXd BetasFor(const BodyModel& body, const Eigen::VectorXd& betas, Eigen::Index count) {
  Eigen::VectorXd taken = Eigen::VectorXd::Zero(count);
  const Eigen::Index given = std::min<Eigen::Index>({betas.size(), count, body.num_betas()});
  taken.head(given) = betas.head(given);
  return taken;
}

}  // namespace

InitialiserGain GainOverInitialiser(const BodyModel& body, const KeypointSequence* keypoints, const Motion& initialiser,
                                    const Camera& initialiser_camera, const Track& fit) {
  const int T = fit.num_frames(), J = body.num_joints();
  BODYLOOM_CHECK(initialiser.num_frames() == T && (keypoints == nullptr || keypoints->num_frames() == T),
                 "initialiser gain: ", initialiser.num_frames(), " frames of the initialiser, ", T, " of the fit");
  const Eigen::Index B = std::min<Eigen::Index>(
      {body.num_betas(), Kinematics::kMaxBetas, std::max(initialiser.betas.size(), fit.motion.betas.size())});
  const bool has_place = fit.camera.model != CameraModel::kWeakPerspective;
  const Eigen::VectorXd betas[] = {BetasFor(body, initialiser.betas, B), BetasFor(body, fit.motion.betas, B)};
  ObservedLandmarks landmarks;
  if (keypoints != nullptr) landmarks = FindObservedLandmarks(body, keypoints, static_cast<int>(B));
  InitialiserGain gain;
  std::vector<double> joint_mm, root_mm, rotation_deg, root_deg, px[2];
  Kinematics kinematics[2];
  PointEvaluator points;
  for (int t = 0; t < T; ++t) {
    if (!initialiser.HasPose(t) || !fit.HasResult(t)) continue;
    ++gain.frames;
    const BodyPose poses[] = {
        PoseFromAxisAngle(body, initialiser.poses.row(t).transpose(), initialiser.trans.row(t).transpose()),
        PoseFromAxisAngle(body, fit.motion.poses.row(t).transpose(), fit.motion.trans.row(t).transpose())};
    for (int i = 0; i < 2; ++i) kinematics[i].Set(body, betas[i], poses[i].rotations, poses[i].trans, false);
    const Vector3d moved = kinematics[1].p[0] - kinematics[0].p[0];
    if (has_place) root_mm.push_back(kMmPerMetre * moved.norm());
    for (int j = 0; j < J; ++j) {
      const double angle = RotationAngleBetween(poses[0].rotations[j], poses[1].rotations[j]) / kDegree;
      (j == 0 ? root_deg : rotation_deg).push_back(angle);
      if (j > 0) joint_mm.push_back(kMmPerMetre * (kinematics[1].p[j] - kinematics[0].p[j] - moved).norm());
    }
    const Camera camera = fit.CameraAt(t);
    for (size_t k = 0; k < landmarks.names.size(); ++k) {
      const Keypoint& seen = keypoints->at(t, landmarks.keypoint_column[k]);
      if (!(seen.confidence > kShownConfidence)) continue;
      Vector2d before, after;
      if (!initialiser_camera.Project(points.Evaluate(kinematics[0], landmarks.points[k], false), &before) ||
          !camera.Project(points.Evaluate(kinematics[1], landmarks.points[k], false), &after)) {
        continue;
      }
      px[0].push_back((before - Vector2d(seen.x, seen.y)).norm());
      px[1].push_back((after - Vector2d(seen.x, seen.y)).norm());
    }
  }
  gain.landmarks = static_cast<int>(px[0].size());
  gain.joint_mm = Summarise(joint_mm);
  gain.root_mm = Summarise(root_mm);
  gain.rotation_deg = Summarise(rotation_deg);
  gain.root_deg = Summarise(root_deg);
  gain.initialiser_px = Summarise(px[0]);
  gain.fit_px = Summarise(px[1]);
  return gain;
}

InitialiserGain GainOverLandmarks(const BodyModel& body, const KeypointSequence* keypoints,
                                  const std::vector<MatrixX3d>& landmarks, const Camera& camera, const Track& fit) {
  const int T = fit.num_frames();
  BODYLOOM_CHECK(static_cast<int>(landmarks.size()) == T && (keypoints == nullptr || keypoints->num_frames() == T),
                 "initialiser gain: ", landmarks.size(), " frames of the initialiser, ", T, " of the fit");
  const Eigen::Index B = std::min<Eigen::Index>({body.num_betas(), Kinematics::kMaxBetas, fit.motion.betas.size()});
  const Eigen::VectorXd betas = BetasFor(body, fit.motion.betas, B);
  const LiftedLandmarks compiled = CompileLiftedLandmarks(body, static_cast<int>(B));
  std::array<int, kLifterPoints> column{};
  for (int k = 0; k < kLifterPoints; ++k) {
    column[k] = -1;
    if (keypoints == nullptr) continue;
    const auto found = std::find(keypoints->names.begin(), keypoints->names.end(), LifterPointNames()[k]);
    if (found != keypoints->names.end()) column[k] = static_cast<int>(found - keypoints->names.begin());
  }
  const bool has_place = fit.camera.model != CameraModel::kWeakPerspective;
  InitialiserGain gain;
  std::vector<double> joint_mm, root_mm, px[2];
  Kinematics kinematics;
  PointEvaluator points;
  for (int t = 0; t < T; ++t) {
    if (landmarks[t].rows() != kLifterPoints || !fit.HasResult(t)) continue;
    ++gain.frames;
    const BodyPose pose =
        PoseFromAxisAngle(body, fit.motion.poses.row(t).transpose(), fit.motion.trans.row(t).transpose());
    kinematics.Set(body, betas, pose.rotations, pose.trans, false);
    MatrixX3d after(kLifterPoints, 3);
    for (int k = 0; k < kLifterPoints; ++k) {
      after.row(k).setConstant(std::numeric_limits<double>::quiet_NaN());
      if (compiled.known[k]) after.row(k) = points.Evaluate(kinematics, compiled.points[k], false).transpose();
    }
    const Eigen::RowVector3d moved = 0.5 * (after.row(kLifterLeftHip) + after.row(kLifterLeftHip + 1) -
                                            landmarks[t].row(kLifterLeftHip) - landmarks[t].row(kLifterLeftHip + 1));
    if (has_place) root_mm.push_back(kMmPerMetre * moved.norm());
    const Camera fit_camera = fit.CameraAt(t);
    for (int k = 0; k < kLifterPoints; ++k) {
      if (!compiled.known[k]) continue;
      joint_mm.push_back(kMmPerMetre * (after.row(k) - landmarks[t].row(k) - moved).norm());
      if (column[k] < 0) continue;
      const Keypoint& seen = keypoints->at(t, column[k]);
      Vector2d before_px, after_px;
      if (!(seen.confidence > kShownConfidence) || !camera.Project(landmarks[t].row(k).transpose(), &before_px) ||
          !fit_camera.Project(after.row(k).transpose(), &after_px)) {
        continue;
      }
      px[0].push_back((before_px - Vector2d(seen.x, seen.y)).norm());
      px[1].push_back((after_px - Vector2d(seen.x, seen.y)).norm());
    }
  }
  gain.landmarks = static_cast<int>(px[0].size());
  gain.joint_mm = Summarise(joint_mm);
  gain.root_mm = Summarise(root_mm);
  gain.rotation_deg = gain.root_deg = Summarise({});
  gain.initialiser_px = Summarise(px[0]);
  gain.fit_px = Summarise(px[1]);
  return gain;
}

}  // namespace bodyloom
