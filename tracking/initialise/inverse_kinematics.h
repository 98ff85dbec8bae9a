// SPDX-License-Identifier: Apache-2.0
/// Analytic inverse kinematics: 3D joints in CocoNames() order → joint rotations of a body with SMPL's tree.
///
/// The trunk is a rigid plate. A limb's upper joint takes the swing onto the bone's direction and the twist that puts
/// the hinge (elbow, knee) perpendicular to the plane of both bones; for a nearly straight limb, whose plane is not
/// determined, the twist of the shortest swing takes over smoothly. The hinge takes what is left.
#pragma once

#include <Eigen/Core>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/geometry/posed_body.h"

namespace bodyloom {

/// `points` 17×3 (NaN rows: that limb stays at rest), `torso_rotation` as JointHypothesis; `rest_joints` J×3 and
/// `rest_points` 17×3 of the same shape. The translation puts the body's mid-hip on the points'. Throws when the body
/// lacks SMPL's limb joints by name.
BodyPose PoseFromJoints(const BodyModel& model, const MatrixX3d& rest_joints, const MatrixX3d& rest_points,
                        const MatrixX3d& points, const Eigen::Matrix3d& torso_rotation);

}  // namespace bodyloom
