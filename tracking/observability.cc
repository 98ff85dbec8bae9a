// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/observability.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/tracking/kinematics.h"

namespace bodyloom {
namespace {

constexpr double kMinLever = 0.04;  ///< metres a radian

}  // namespace

ObservedLandmarks FindObservedLandmarks(const BodyModel& model, const KeypointSequence* keypoints, int num_betas) {
  ObservedLandmarks result;
  if (keypoints == nullptr) return result;
  for (int k = 0; k < keypoints->num_points(); ++k) {
    const int index = model.FindLandmark(keypoints->names[k]);
    if (index < 0) continue;
    const Landmark& landmark = model.data().landmarks[index];
    result.names.push_back(landmark.name);
    result.keypoint_column.push_back(k);
    result.points.push_back(CompilePoint(model, landmark.vertices, landmark.weights, num_betas));
  }
  BODYLOOM_CHECK(!result.names.empty(), "track: the body '", model.name(), "' has none of the detections' ",
                 keypoints->num_points(), " landmarks (", keypoints->convention,
                 "); the built-in body and SMPL files have COCO-17, toes and heels");
  return result;
}

std::vector<int> FindActiveJoints(const BodyModel& model, const ObservedLandmarks& landmarks, bool dense, bool skip) {
  std::vector<int> all(model.num_joints());
  std::iota(all.begin(), all.end(), 0);
  if (dense || !skip) return all;
  Kinematics kinematics;
  PointEvaluator points;
  kinematics.Set(model, Eigen::VectorXd(),
                 std::vector<Eigen::Matrix3d>(model.num_joints(), Eigen::Matrix3d::Identity()), Eigen::Vector3d::Zero(),
                 true);
  std::vector<double> lever(model.num_joints(), 0);
  for (const CompiledPoint& point : landmarks.points) {
    points.Evaluate(kinematics, point, true);
    for (int j : points.joints())
      lever[j] = std::max(lever[j], points.JointJacobian(kinematics, j).norm() / std::sqrt(2.0));
  }
  std::vector<int> active;
  for (int j : all) {
    if (j == 0 || lever[j] >= kMinLever) active.push_back(j);
  }
  return active;
}

double KeypointSigmaPx(double confidence, double height_px) {
  return (0.022 + 0.033 * std::pow(1 - std::clamp(confidence, 0.0, 1.0), 1.5)) * height_px;
}

std::vector<LandmarkObservation> ObserveLandmarks(const ObservedLandmarks& landmarks, const KeypointSequence& keypoints,
                                                  int t, double height_px) {
  std::vector<LandmarkObservation> result;
  for (size_t i = 0; i < landmarks.names.size(); ++i) {
    const Keypoint& point = keypoints.at(t, landmarks.keypoint_column[i]);
    if (!(point.confidence >= kMinConfidence) || !std::isfinite(point.x) || !std::isfinite(point.y)) continue;
    result.push_back({&landmarks.points[i], {point.x, point.y}, KeypointSigmaPx(point.confidence, height_px)});
  }
  return result;
}

}  // namespace bodyloom
