// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/initialise/inverse_kinematics.h"

#include <Eigen/Geometry>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/rotation.h"
#include "bodyloom/tracking/initialise/joint_hypotheses.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Orthonormal axes with the first along `along` and the second as near as possible to `normal`.
Matrix3d Triad(const Vector3d& along, const Vector3d& normal) {
  Matrix3d axes;
  axes.col(0) = along.normalized();
  axes.col(1) = (normal - axes.col(0) * axes.col(0).dot(normal)).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

struct Limb {
  const char *upper, *hinge, *end;
  Vector3d hinge_axis;  ///< rest frame; a positive turn flexes
};

const Limb kBodyLimbs[4] = {
    {"l_shoulder", "l_elbow", "l_wrist", {0, -1, 0}},
    {"r_shoulder", "r_elbow", "r_wrist", {0, 1, 0}},
    {"l_hip", "l_knee", "l_ankle", {1, 0, 0}},
    {"r_hip", "r_knee", "r_ankle", {1, 0, 0}},
};

/// sin of the bend below which the shortest swing begins to decide the twist.
constexpr double kStraight = 0.2;

}  // namespace

BodyPose PoseFromJoints(const BodyModel& model, const MatrixX3d& rest_joints, const MatrixX3d& rest_points,
                        const MatrixX3d& points, const Matrix3d& torso_rotation) {
  BODYLOOM_CHECK(points.rows() == 17 && rest_points.rows() == 17, "inverse kinematics: ", points.rows(), " points and ",
                 rest_points.rows(), " rest points, expected 17 of each");
  BodyPose pose;
  pose.rotations.assign(model.num_joints(), Matrix3d::Identity());
  Matrix3d rest_torso = Matrix3d::Identity();
  BODYLOOM_CHECK(TorsoFrame(rest_points, &rest_torso), "inverse kinematics: the body's rest pose has no torso");
  pose.rotations[0] = torso_rotation * rest_torso.transpose();
  for (int l = 0; l < 4; ++l) {
    const Limb& limb = kBodyLimbs[l];
    const int upper = model.FindJoint(limb.upper), hinge = model.FindJoint(limb.hinge), end = model.FindJoint(limb.end);
    BODYLOOM_CHECK(upper >= 0 && hinge >= 0 && end >= 0, "inverse kinematics: the body '", model.name(),
                   "' has no joint ", limb.upper, ", ", limb.hinge, " or ", limb.end);
    const Vector3d start = points.row(kLimbs[l][0]), middle = points.row(kLimbs[l][1]), tip = points.row(kLimbs[l][2]);
    const Vector3d upper_bone = middle - start, lower_bone = tip - middle;
    if (!upper_bone.allFinite() || !(upper_bone.norm() > 0)) continue;
    const Matrix3d parent = pose.rotations[0];  // the trunk between root and limb is at rest
    const Vector3d rest_upper = (rest_joints.row(hinge) - rest_joints.row(upper)).transpose();
    const Vector3d rest_lower = (rest_joints.row(end) - rest_joints.row(hinge)).transpose();
    const Matrix3d shortest = RotationBetweenDirections(parent * rest_upper, upper_bone) * parent;
    Matrix3d world = shortest;
    if (lower_bone.allFinite() && lower_bone.norm() > 0) {
      const Vector3d normal = upper_bone.normalized().cross(lower_bone.normalized());
      const double known = normal.norm() / kStraight;
      const Vector3d blended = known >= 1 ? normal : normal + (1 - known) * kStraight * (shortest * limb.hinge_axis);
      if (blended.norm() > 1e-9) {
        world = Triad(upper_bone, blended) * Triad(rest_upper, limb.hinge_axis).transpose();
      }
      pose.rotations[hinge] = RotationBetweenDirections(rest_lower, world.transpose() * lower_bone);
    }
    pose.rotations[upper] = parent.transpose() * world;
  }
  const Vector3d rest_hips = (rest_points.row(11) + rest_points.row(12)).transpose() / 2;
  const Vector3d hips = (points.row(11) + points.row(12)).transpose() / 2;
  const Vector3d pelvis = rest_joints.row(0).transpose();
  pose.trans = hips - (pelvis + pose.rotations[0] * (rest_hips - pelvis));
  return pose;
}

}  // namespace bodyloom
