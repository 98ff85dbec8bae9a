// SPDX-License-Identifier: Apache-2.0
/// Poses and cameras for tests: seeded, plausible angles, and a body that stands in front of the camera.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera.h"

namespace bodyloom {

/// 3J axis-angle values: every joint turned by up to `amplitude_rad` about a random axis; the root upright in the
/// camera frame (y down) and facing it, then turned by the same law.
inline Eigen::VectorXd RandomAxisAngle(const BodyModel& body, uint32_t seed, double amplitude_rad) {
  std::mt19937 generator(seed);
  const auto uniform = [&] { return generator() / 4294967296.0 * 2 - 1; };
  Eigen::VectorXd pose = Eigen::VectorXd::Zero(3 * body.num_joints());
  for (Eigen::Index i = 0; i < pose.size(); ++i) pose[i] = amplitude_rad * uniform() / std::sqrt(3.0);
  const Eigen::Matrix3d upright = RotationFromAxisAngle(Eigen::Vector3d(M_PI, 0, 0));
  pose.head<3>() = AxisAngleFromRotation(upright * RotationFromAxisAngle(pose.head<3>()));
  return pose;
}

/// A random pose with the pelvis `distance_m` in front of the camera.
inline BodyPose RandomPose(const BodyModel& body, uint32_t seed, double amplitude_rad, double distance_m) {
  const Eigen::Vector3d pelvis = body.joint_template().row(0).transpose();
  return PoseFromAxisAngle(body, RandomAxisAngle(body, seed, amplitude_rad),
                           Eigen::Vector3d(0, 0, distance_m) - pelvis);
}

/// A lens with visible barrel distortion.
inline Camera DistortedCamera(int width, int height, double focal_px) {
  Camera camera = MakePinhole(width, height, focal_px);
  camera.distortion = {-0.12, 0.03, 0.002, -0.001, 0, 0, 0, 0};
  return camera;
}

inline Camera WeakCamera(int width, int height, double scale_px_per_m) {
  Camera camera;
  camera.model = CameraModel::kWeakPerspective;
  camera.width = width;
  camera.height = height;
  camera.cx = (width - 1) / 2.0;
  camera.cy = (height - 1) / 2.0;
  camera.scale = scale_px_per_m;
  return camera;
}

}  // namespace bodyloom
