// SPDX-License-Identifier: Apache-2.0
/// Poses of a stretch of frames in the form that windows are made in: unit quaternions of SMPL's 24 joints.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "bodyloom/data_tools/synthesis/pose_joints.h"

namespace bodyloom {

/// The same turn seen in a mirror at x = 0.
inline Eigen::Quaternionf MirrorRotation(const Eigen::Quaternionf& q) { return {q.w(), q.x(), -q.y(), -q.z()}; }

/// World: y up.
struct PoseSequence {
  int num_frames = 0;
  bool has_floor = false;
  std::vector<Eigen::Quaternionf> rotations;  ///< T·24, relative to the parent
  std::vector<Eigen::Vector3f> trans;         ///< T, of the pelvis, metres of the mean body
  std::vector<float> clearance;               ///< T: lowest point above the floor, metres of the mean body
  Eigen::Quaternionf& at(int t, int joint) { return rotations[static_cast<size_t>(t) * kPoseJoints + joint]; }
  [[nodiscard]] const Eigen::Quaternionf& at(int t, int joint) const {
    return rotations[static_cast<size_t>(t) * kPoseJoints + joint];
  }
};

/// The turn by |w| radians about w. Series in the half angle's square: within 2e-7 up to 3 rad, libm's beyond.
inline Eigen::Quaternionf TurnBy(const Eigen::Vector3f& w) {
  const float h = 0.25F * w.squaredNorm();
  if (h > 2.25F) {
    const float half = std::sqrt(h), s = 0.5F * std::sin(half) / half;
    return {std::cos(half), s * w.x(), s * w.y(), s * w.z()};
  }
  const float c =
      1 - h * (1.F / 2 - h * (1.F / 24 - h * (1.F / 720 - h * (1.F / 40320 - h * (1.F / 3628800 - h / 479001600)))));
  const float s = 0.5F - h * (1.F / 12 - h * (1.F / 240 - h * (1.F / 10080 - h * (1.F / 725760 - h / 79833600))));
  return {c, s * w.x(), s * w.y(), s * w.z()};
}

/// Its inverse; angles in [0, π].
inline Eigen::Vector3f AxisAngleOf(const Eigen::Quaternionf& q) {
  const Eigen::Vector3f v = q.w() < 0 ? Eigen::Vector3f(-q.vec()) : Eigen::Vector3f(q.vec());
  const float s = v.norm();
  return s < 1e-6F ? Eigen::Vector3f(2 * v) : Eigen::Vector3f(2 * std::atan2(s, std::abs(q.w())) / s * v);
}

/// From a (part 0) to b (part 1) by the short way, at nearly constant speed.
inline Eigen::Quaternionf Between(const Eigen::Quaternionf& a, const Eigen::Quaternionf& b, float part) {
  const float sign = a.dot(b) < 0 ? -part : part;
  return Eigen::Quaternionf((1 - part) * a.coeffs() + sign * b.coeffs()).normalized();
}

}  // namespace bodyloom
