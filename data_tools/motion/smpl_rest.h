// SPDX-License-Identifier: Apache-2.0
/// Joint positions of the built-in body's mean shape in T-pose, the zero of SMPL's joint rotations. Bone directions of
/// other bodies of the family differ by a few degrees.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// 24×3 metres, body frame (x left, y up, z front), pelvis at the origin.
const MatrixX3d& SmplRestJoints();

/// 24×3 joint positions for 72 axis-angle values, pelvis joint at `pelvis`.
MatrixX3d PoseSmplJoints(const Eigen::Ref<const Eigen::VectorXd>& pose, const Eigen::Vector3d& pelvis);

/// The same for every frame of a motion of 24 joints with y up; the pelvis is at `trans`.
std::vector<MatrixX3d> PoseSmplJoints(const Motion& motion);

/// Flexion of the hinge joints from the straight limb, degrees, positive in the natural direction: left knee, right
/// knee, left elbow, right elbow. Measured in the plane of natural flexion (shin backwards, T-pose forearm forwards).
Eigen::Vector4d HingeFlexionDeg(const Eigen::Ref<const Eigen::VectorXd>& pose);

}  // namespace bodyloom
