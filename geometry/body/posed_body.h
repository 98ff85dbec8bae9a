// SPDX-License-Identifier: Apache-2.0
/// Poses a body: forward kinematics and linear blend skinning of one frame, for all vertices or a chosen few.
/// Formulas in geometry/body/body_model.h. For many frames at once use Skinner (geometry/body/skinning.h).
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

/// Joint rotations relative to the parent (the root's: frame-from-body) and translation, metres.
struct BodyPose {
  std::vector<Eigen::Matrix3d> rotations;  ///< J
  Eigen::Vector3d trans = Eigen::Vector3d::Zero();
};

/// Converts 3J axis-angle values, to which the body's pose_mean is added; fewer leave the remaining joints at zero, but
/// of 72 values, SMPL's 24 joints, on a body with finger joints the last six turn the knuckles of both hands' index to
/// little finger. Throws std::invalid_argument when there are more than 3J or they are not finite.
BodyPose PoseFromAxisAngle(const BodyModel& model, const Eigen::Ref<const Eigen::VectorXd>& axis_angle,
                           const Eigen::Vector3d& trans);

/// Inverse of PoseFromAxisAngle: 3J axis-angle values with angles in [0, π] (pose_mean subtracted).
Eigen::VectorXd AxisAngleFromPose(const BodyModel& model, const BodyPose& pose);

/// The kinematic tree of one frame.
struct PosedSkeleton {
  MatrixX3d rest_joints;                         ///< J×3
  std::vector<Eigen::Matrix3d> world_rotations;  ///< J: frame-from-joint
  MatrixX3d joints;                              ///< J×3 positions, trans included
};

PosedSkeleton PoseSkeleton(const BodyModel& model, const MatrixX3d& rest_joints, const BodyPose& pose);

/// V×3 vertices, in double throughout. betas may be shorter than the body's.
MatrixX3d PoseVertices(const BodyModel& model, const Eigen::VectorXd& betas, const BodyPose& pose);

/// Only the listed vertices, in that order (n×3); no other vertex is touched.
MatrixX3d PoseVertices(const BodyModel& model, const Eigen::VectorXd& betas, const BodyPose& pose,
                       std::span<const int> vertices);

/// The body's landmarks by name (n×3), from only the vertices they need. Throws when the body lacks one.
MatrixX3d PoseLandmarks(const BodyModel& model, const Eigen::VectorXd& betas, const BodyPose& pose,
                        const std::vector<std::string>& names);

/// v_template + shapedirs·betas, V×3.
MatrixX3d ShapeVertices(const BodyModel& model, const Eigen::VectorXd& betas);

/// The two blend shapes of one vertex, the terms of its rest position v_rest = ShapedVertex + PoseCorrective.
/// Indices and sizes are the caller's responsibility.
Eigen::Vector3d ShapedVertex(const BodyModel& model, const Eigen::VectorXd& betas, int vertex);
Eigen::Vector3d PoseCorrective(const BodyModel& model, const BodyPose& pose, int vertex);

}  // namespace bodyloom
