// SPDX-License-Identifier: Apache-2.0
/// Joint angles that the positions of COCO's 17 landmarks determine, to compare poses of which no more is known.
///
/// With t the direction from the middle of the hips to that of the shoulders, a frame at the hips has y = t, z the line
/// from the left hip to the right one made perpendicular to y, x = y × z (forward); a frame at the shoulders likewise
/// with the line of the shoulders. A thigh or upper arm with the direction d = Rz(a) Rx(b) (0, 1, 0) from its far end
/// to its near one has
///   hip_flexion, arm_flex = a        hip_adduction, arm_add = b for the right side, −b for the left
/// and knee_angle, elbow_flex = 180° − the angle at the joint, lumbar_rotation the turn about t of the shoulders' line
/// against that of the hips. They have the signs of geometry/biomechanics/joint_angles.h, but another zero: the trunk
/// stands in for the pelvis, a bent spine is part of hip_flexion, and limbs in line are the zero of knees and elbows.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

inline constexpr int kNumLandmarkAngles = 13;
using LandmarkAngleRow = Eigen::Matrix<double, 1, kNumLandmarkAngles>;

/// Names, as in joint_angles.h.
const std::vector<std::string>& LandmarkAngleNames();

/// Degrees, of 17×3 points (CocoNames() in order) in any right-handed frame and unit of length. An angle is NaN when a
/// point that it needs is not finite, and hip_flexion or arm_flex also where the limb is within 30° of the line of the
/// hips or shoulders, where small errors of the points turn it. Throws std::invalid_argument for another number of
/// rows.
LandmarkAngleRow LandmarkAngles(const MatrixX3d& coco17);

/// 180° − the angle at `joint` between the directions to its neighbours, degrees: 0 where the three are in line.
double FlexionDeg(const Eigen::Vector3d& near, const Eigen::Vector3d& joint, const Eigen::Vector3d& far);

}  // namespace bodyloom
