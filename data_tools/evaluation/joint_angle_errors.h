// SPDX-License-Identifier: Apache-2.0
/// Errors of joint angles: of OpenSim's coordinates where the true pose of a body is known, and of the angles that
/// COCO's landmarks determine where true landmarks are.
///
/// Differences (track − truth) are wrapped to ±180°; nothing is removed from them before. Of hips, arms and lumbar
/// the triple of the track is taken that is nearer to the truth's, since two triples are the same rotation, and
/// arm_flex and arm_rot are left out where the true arm_add is within 30° of ±90°, where they are not determined.
///   gait_angle_err_deg         mean absolute difference of pelvis_tilt, _list, _rotation, hips, knee_angle,
///                              ankle_angle and lumbar: the mean over these 16 coordinates of the means over frames
///   arm_angle_err_deg          the same of arm_flex, _add, _rot and elbow_flex
///   coordinate_err_deg, coordinate_bias_deg (breakdowns)    mean absolute and mean difference, by coordinate
///   coordinate_group_err_deg (breakdown)                    by pelvis, hips, knees, ankles, lumbar, arms, elbows
///   landmark_angle_err_deg     mean over the angles of geometry/biomechanics/landmark_angles.h; breakdowns of the same
///                              name and landmark_angle_bias_deg, by angle
/// The pelvis' angles are in the track's own world and in the true one, so that a lean counts; both head where the
/// camera looks.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "data_tools/evaluation/evaluation.h"
#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/track.h"
#include "geometry/scene/world_frame.h"

namespace bodyloom {

/// Of C angles, degrees; NaN for an angle that no frame has.
struct AngleErrors {
  Eigen::VectorXd mean_abs_deg, bias_deg;
};

/// T×C angles, degrees; those that are not finite on either side are left out. Throws std::invalid_argument when the
/// sizes differ.
AngleErrors CompareAngles(const RowMatrixXd& track_deg, const RowMatrixXd& truth_deg);

/// The track's coordinates (T×kNumCoordinates) with the triples of hips, arms and lumbar that are nearer to the
/// truth's, and NaN for arm_flex and arm_rot where they are not determined.
RowMatrixXd NearestTriples(const RowMatrixXd& track, const RowMatrixXd& truth);

/// Adds the errors of coordinates, frame source[t] of `track` against frame t of `truth`, both on `body`; a track
/// without a world is measured in the true one. Adds nothing for a body without the joints (HasJointAngles()).
void AddCoordinateErrors(const Track& track, const std::vector<int>& source, const Track& truth, const BodyModel& body,
                         const WorldFrame& true_world, Evaluation* evaluation);

/// Adds the errors of the landmarks' angles; T of 17×3 points each.
void AddLandmarkAngleErrors(const std::vector<MatrixX3d>& track, const std::vector<MatrixX3d>& truth,
                            Evaluation* evaluation);

}  // namespace bodyloom
