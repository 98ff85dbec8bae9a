// SPDX-License-Identifier: Apache-2.0
/// How bent the knees of a motion are.
#pragma once

#include "bodyloom/data_tools/evaluation/evaluation.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

/// Median of the knees' flexion over the frames with a pose and both knees, degrees. Flexion is the x component of a
/// knee's axis-angle (SMPL's joints 4 and 5; tracking/terms/joint_limits.h has the frame): 0 where thigh and shin are in
/// line as in the rest pose. NaN without such frames, and for poses of fewer than six joints.
double MedianKneeFlexionDeg(const Motion& motion);

/// Adds `knee_flexion_deg`, and with a truth `gt_knee_flexion_deg`.
void AddKneeFlexion(const Motion& estimate, const Motion* truth, Evaluation* evaluation);

/// Protocol "track-alone", where nothing is known to compare with: the knees' flexion.
Evaluation EvaluateAlone(const Track& track);

}  // namespace bodyloom
