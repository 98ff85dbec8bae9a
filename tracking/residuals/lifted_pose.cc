// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/residuals/lifted_pose.h"

#include <algorithm>

#include "bodyloom/tracking/initialise/lifter_input.h"

namespace bodyloom {

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
  return result;
}

LiftedPose MakeLiftedPose(const LiftedFrame& frame, const LiftedLandmarks& landmarks, double metres,
                          double min_sigma_m) {
  LiftedPose pose;
  pose.landmarks = &landmarks;
  const Eigen::Matrix3d& R = frame.camera_from_virtual;
  for (int k = 0; k < kLifterPoints; ++k) {
    if (!landmarks.known[k]) continue;
    const double across = 1 / std::max(min_sigma_m, metres * frame.sigma(k, 0));
    const double along = 1 / std::max(min_sigma_m, metres * frame.sigma(k, 1));
    LiftedPose::Point& point = pose.points.emplace_back();
    point.landmark = k;
    point.offset = metres * frame.points.row(k).transpose();
    point.whitening = R * Eigen::Vector3d(across, across, along).asDiagonal() * R.transpose();
  }
  return pose;
}

}  // namespace bodyloom
