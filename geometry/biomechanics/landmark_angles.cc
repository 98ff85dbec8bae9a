// SPDX-License-Identifier: Apache-2.0
#include "geometry/biomechanics/landmark_angles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/check.h"
#include "geometry/base/units.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// COCO's order; the right side is one further.
constexpr int kLeftShoulder = 5, kLeftElbow = 7, kLeftWrist = 9, kLeftHip = 11, kLeftKnee = 13, kLeftAnkle = 15;
constexpr double kUndetermined = 30 * kDegree;

/// Columns x forward, y along the trunk, z to the right, of a line from left to right.
Matrix3d TrunkFrame(const Vector3d& trunk, const Vector3d& line) {
  Matrix3d frame;
  frame.col(1) = trunk.normalized();
  frame.col(2) = (line - line.dot(frame.col(1)) * frame.col(1)).normalized();
  frame.col(0) = frame.col(1).cross(frame.col(2));
  return frame;
}

/// Flexion and adduction of a limb from `far` to `near`; side is 0 for the left.
Eigen::RowVector2d SwingDeg(const Matrix3d& frame, const Vector3d& near, const Vector3d& far, int side) {
  const Vector3d d = frame.transpose() * (near - far).normalized();
  const double adduction = std::asin(std::clamp(d.z(), -1.0, 1.0));
  const double cosine = std::hypot(d.x(), d.y());
  const double flexion =
      cosine < std::sin(kUndetermined) ? std::numeric_limits<double>::quiet_NaN() : std::atan2(-d.x(), d.y()) / kDegree;
  return {flexion, (side == 0 ? -1 : 1) * adduction / kDegree};
}

}  // namespace

const std::vector<std::string>& LandmarkAngleNames() {
  static const std::vector<std::string> names = {
      "hip_flexion_r", "hip_adduction_r", "knee_angle_r", "hip_flexion_l", "hip_adduction_l",
      "knee_angle_l",  "lumbar_rotation", "arm_flex_r",   "arm_add_r",     "elbow_flex_r",
      "arm_flex_l",    "arm_add_l",       "elbow_flex_l"};
  return names;
}

double FlexionDeg(const Vector3d& near, const Vector3d& joint, const Vector3d& far) {
  const Vector3d a = near - joint, b = far - joint;
  return 180 - std::atan2(a.cross(b).norm(), a.dot(b)) / kDegree;
}

LandmarkAngleRow LandmarkAngles(const MatrixX3d& coco17) {
  BODYLOOM_CHECK(coco17.rows() == 17, "landmark angles: ", coco17.rows(), " points, expected COCO's 17");
  const auto at = [&](int left, int side) { return Vector3d(coco17.row(left + side).transpose()); };
  const Vector3d hips = at(kLeftHip, 1) - at(kLeftHip, 0), shoulders = at(kLeftShoulder, 1) - at(kLeftShoulder, 0);
  const Vector3d trunk =
      0.5 * (at(kLeftShoulder, 0) + at(kLeftShoulder, 1)) - 0.5 * (at(kLeftHip, 0) + at(kLeftHip, 1));
  const Matrix3d at_hips = TrunkFrame(trunk, hips), at_shoulders = TrunkFrame(trunk, shoulders);
  LandmarkAngleRow row;
  for (const int side : {1, 0}) {
    const int leg = side == 1 ? 0 : 3, arm = side == 1 ? 7 : 10;
    row.segment<2>(leg) = SwingDeg(at_hips, at(kLeftHip, side), at(kLeftKnee, side), side);
    row[leg + 2] = FlexionDeg(at(kLeftHip, side), at(kLeftKnee, side), at(kLeftAnkle, side));
    row.segment<2>(arm) = SwingDeg(at_shoulders, at(kLeftShoulder, side), at(kLeftElbow, side), side);
    row[arm + 2] = FlexionDeg(at(kLeftShoulder, side), at(kLeftElbow, side), at(kLeftWrist, side));
  }
  const Matrix3d turn = at_hips.transpose() * at_shoulders;  // about y alone
  row[6] = std::atan2(turn(0, 2), turn(2, 2)) / kDegree;
  return row;
}

}  // namespace bodyloom
