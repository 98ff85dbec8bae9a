// SPDX-License-Identifier: Apache-2.0
/// Gives the built-in body SMPL-H's finger joints (geometry/body/hand_skeleton.h): 52 joints in place of 24, on the
/// same vertices. Nothing is stored for them: all follows from the cage's finger tubes and the numbers in the .cc file.
///
///   centreline  means of the nine rings of vertices of a tube, from its base to its tip; of the thumb after the CMC
///   joints      at the knuckle and at the phalanges' shares of the centreline; rows of ring means, so that joints move
///               with the shape
///   weights     the share of wrist and hand joint of the 24-joint body, divided by smooth steps across each joint
///   correctives fitted to rotations by the weighted angle, which keep a vertex at its distance from the joint
///
/// With resting fingers the body equals the 24-joint one whose hand joints rest. Steps and sources:
/// assets/body/RECIPE.md, section 9.
#pragma once

#include "data_tools/body_making/cage.h"
#include "data_tools/body_making/subdivision.h"
#include "geometry/body/body_model.h"

namespace bodyloom {

/// `body` is MakeBuiltinBody()'s of that cage. Joints 0–21 stay, l_hand and r_hand (22, 23) give way to the left
/// fingers (22–36) and the right ones (37–51); hand landmarks are added. Throws std::invalid_argument when the cage has
/// no finger tubes by its names (assets/body/RECIPE.md, section 3).
void AddFingerJoints(const Cage& cage, const RefinedCage& refined, BodyModelData* body);

}  // namespace bodyloom
