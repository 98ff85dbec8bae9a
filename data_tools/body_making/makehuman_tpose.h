// SPDX-License-Identifier: Apache-2.0
/// Puts a MakeHuman person into the T-pose of the built-in body and finds SMPL's 24 joints in it.
///
/// Pose (left side; the right side is its mirror image), by plain linear blend skinning with the game-engine weights:
///   clavicle raised by 10°; upper and lower arm along +x with the elbow's axis vertical, so that bending brings the
///   forearm to the front; palm down, hand along +x; fingers spread by 7/1/−5/−12° and curled by 4/12/16°;
///   thigh along (.045,−1,−.02), shin along (.035,−1,−.03), foot turned out by 7°, its slope kept
/// Joints from the joint cubes: RECIPE.md of the built-in body, section 6; the hand joint a tenth of the way from the
/// knuckles to the wrist, where it lies inside this mesh's hand.
#pragma once

#include <vector>

#include "bodyloom/data_tools/body_making/makehuman_files.h"

namespace bodyloom {

struct MakeHumanTPose {
  MatrixX3d vertices;  ///< of the body, metres, pelvis joint at the origin
  MatrixX3d joints;    ///< 24×3 in SMPL's order, metres
};

/// vertices_dm: all vertices as from BlendMakeHuman. Throws std::runtime_error when the rig lacks a bone or a cube that
/// the T-pose needs.
MakeHumanTPose PoseMakeHuman(const MakeHumanFiles& files, const MatrixX3d& vertices_dm, double metres_per_unit);

}  // namespace bodyloom
