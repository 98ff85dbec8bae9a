// SPDX-License-Identifier: Apache-2.0
/// Skinning weights and joint regressor for SMPL's 24 joints from MakeHuman's 53 bones.
#pragma once

#include <vector>

#include "bodyloom/data_tools/body_making/makehuman_files.h"

namespace bodyloom {

/// V×24 weights, at most 4 a row, rows sum to 1. joints: 24×3 in the T-pose of `vertices` (V×3, metres).
///
/// Fingers go to the hand, the thumb to the wrist, the ball to the foot, the clavicle to the collar. What pelvis and
/// spine bones hold is shared among pelvis, spine1, spine2, spine3 by height: logistic steps of width 23 mm at the
/// joints, since SMPL's spine joints lie elsewhere than the rig's. 14 half-steps of Laplacian smoothing along the edges
/// remove the kinks.
SparseRows SmplWeightsFromMakeHuman(const MakeHumanFiles& files, const MatrixX3d& vertices, const MatrixX3d& joints);

/// 24×V rows of non-negative weights that sum to 1, fitted to the joints of all people (people[i] is V×3, joints[i]
/// 24×3): least squares over at most 120 vertices around the joint that move with it, with a small ridge that spreads
/// the weights. mean_error (24) receives the mean distance, in the units of the input.
SparseRows FitJointRegressor(const std::vector<MatrixX3d>& people, const std::vector<MatrixX3d>& joints,
                             const SparseRows& weights, std::vector<double>* mean_error);

}  // namespace bodyloom
