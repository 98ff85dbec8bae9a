// SPDX-License-Identifier: Apache-2.0
/// Protocols on the joints of Human3.6M: of its own recordings, and of SMPL motions with the regressor of these joints.
///
/// The 17 joints of Human36m17() of a posed body are, where a regressor W (17×V) is given, W times its V vertices, as
/// the field evaluates SMPL. Without one they are the body's own: SMPL's joints, the middle of its hips and, for the
/// top of the head, the vertex that is highest at rest; spine and nose (7, 9) have none. Of these
///   LSP's 14   all but mid-hip, spine and nose
///   root       joint 0, which is moved onto the true one before joints are compared
/// Protocol 1 of Kanazawa et al. (HMR, CVPR 2018) is mpjpe_mm over the four cameras, 2 is pa_mpjpe_mm of the frontal
/// camera ("4"); Protocols 1 and 2 of Martinez et al. (ICCV 2017) are the same two numbers of all 17 joints.
#pragma once

#include <string>
#include <vector>

#include "data_tools/evaluation/evaluation.h"
#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// J_regressor_h36m.npy: 17×V numbers whose rows sum to 1. Throws std::runtime_error naming the file when the body has
/// another number of vertices.
RowMatrixXd ReadJointRegressor(const std::string& path, const BodyModel& body);

/// The 17 joints of frame t of a motion with a pose there, metres in the motion's frame; NaN where there are none. An
/// empty regressor: the body's own joints. Throws std::invalid_argument for a body without SMPL's 22 joints.
MatrixX3d Human36mJoints(const BodyModel& body, const Motion& motion, int t, const RowMatrixXd& regressor);

/// Protocol "h36m": frame t of the track, in its camera's frame, against frame frames[t] of the true joints (17×3
/// metres in the world, without rows where unknown: left out), seen by the camera at `pose`. Values: mpjpe_mm,
/// pa_mpjpe_mm and their spread, accelerations, root error, and errors in the world as EMDB defines them
/// (global_errors.h), the camera standing still; with a regressor mpjpe_17_mm and pa_mpjpe_17_mm. A frame without a
/// result is scored with the nearest frame that has one. Throws std::invalid_argument when no frame is known.
Evaluation EvaluateHuman36m(const Track& track, const std::vector<MatrixX3d>& true_joints,
                            const std::vector<int>& frames, const CameraPose& pose, const BodyModel& body,
                            const RowMatrixXd& regressor);

/// Adds lsp14_mpjpe_mm and lsp14_pa_mpjpe_mm of a track against a truth, both in the camera's frame, both regressed
/// from their vertices. `source` as NearestFramesWithResult().
void AddRegressedJoints(const Track& track, const std::vector<int>& source, const Track& truth, const BodyModel& body,
                        const BodyModel& true_body, const RowMatrixXd& regressor, Evaluation* evaluation);

}  // namespace bodyloom
