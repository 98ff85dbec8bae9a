// SPDX-License-Identifier: Apache-2.0
/// Analytic inverse kinematics: 3D joints in CocoNames() order → joint rotations of a body with SMPL's tree.
///
/// The trunk is rigid. A limb's upper joint takes the swing onto the bone's direction and the twist that puts the hinge
/// (elbow, knee) perpendicular to the plane of both bones; for a nearly straight limb, whose plane is not determined,
/// the twist is blended towards that of the shortest swing. The hinge takes the remaining rotation.
#pragma once

#include <Eigen/Core>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/observations.h"
#include "tracking/initialise/joint_hypotheses.h"

namespace bodyloom {

/// `points` 17×3 (NaN rows: that limb stays at rest), `torso_rotation` as JointHypothesis; `rest_joints` J×3 and
/// `rest_points` 17×3 of the same shape. The translation puts the body's mid-hip on the points'. Throws when the body
/// lacks SMPL's limb joints by name.
BodyPose PoseFromJoints(const BodyModel& model, const MatrixX3d& rest_joints, const MatrixX3d& rest_points,
                        const MatrixX3d& points, const Eigen::Matrix3d& torso_rotation);

/// Estimates shape components from the ratios of projected bone lengths: a bone's largest projections over the clip
/// (90th percentile, relative to the body's apparent size) give its length if it lay in the image plane at some time.
/// Fits log ratios of torso, thighs, shins, upper arms and forearms with σ = 0.03, and N(0, 1) on each component; a log
/// ratio counts at most 0.35 from the mean body's. Zero without enough frames.
Eigen::VectorXd EstimateShape(const KeypointSequence& keypoints, const Camera& camera, const BodyModel& model,
                              int num_betas, const JointHypothesesOptions& options);

}  // namespace bodyloom
