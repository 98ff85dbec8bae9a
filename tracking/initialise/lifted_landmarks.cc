// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/lifted_landmarks.h"

#include <algorithm>

#include "geometry/body/posed_body.h"
#include "tracking/lifter/lifter_input.h"

namespace bodyloom {

namespace {

std::vector<LiftedLandmarks::Nearest> NearestLandmarks(const BodyModel& model, const LiftedLandmarks& landmarks) {
  BodyPose rest;
  rest.rotations.assign(model.num_joints(), Eigen::Matrix3d::Identity());
  const MatrixX3d joints = model.RestJoints(Eigen::VectorXd());
  const MatrixX3d points = PoseLandmarks(model, Eigen::VectorXd(), rest, LifterPointNames());
  const Eigen::RowVector3d hips = points.middleRows<2>(kLifterLeftHip).colwise().mean();
  std::vector<LiftedLandmarks::Nearest> nearest(model.num_joints());
  for (int j = 0; j < model.num_joints(); ++j) {
    double minimum = 0;
    for (int k = 0; k < kLifterPoints; ++k) {
      if (!landmarks.known[k]) continue;
      const double distance = (points.row(k) - joints.row(j)).norm();
      if (nearest[j].landmark >= 0 && distance >= minimum) continue;
      minimum = distance;
      nearest[j].landmark = k;
      nearest[j].share = std::min(1.0, (joints.row(j) - hips).norm() / (points.row(k) - hips).norm());
    }
  }
  return nearest;
}

}  // namespace

bool LiftedLandmarks::IsUsable() const {
  for (const int k : {int{kLifterLeftShoulder}, int{kLifterLeftHip}, int{kLifterLeftKnee}, int{kLifterLeftAnkle}}) {
    if (!known[k] || !known[k + 1]) return false;
  }
  return true;
}

LiftedLandmarks CompileLiftedLandmarks(const BodyModel& model, int num_betas) {
  LiftedLandmarks result;
  for (int k = 0; k < kLifterPoints; ++k) {
    const int index = model.FindLandmark(LifterPointNames()[k]);
    if (index < 0) continue;
    const Landmark& landmark = model.data().landmarks[index];
    result.points[k] = CompilePoint(model, landmark.vertices, landmark.weights, num_betas);
    result.known[k] = true;
  }
  result.of_joint = NearestLandmarks(model, result);
  return result;
}

}  // namespace bodyloom
