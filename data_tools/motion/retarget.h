// SPDX-License-Identifier: Apache-2.0
/// Retargets the motion of any humanoid skeleton to SMPL's 24 joints.
///
/// Every SMPL joint j follows a source joint s (skeleton_map.h) by its world rotation:
///   W_j(t) = file_from_bodyᵀ · W_s(t) · A_j,   θ_j = W_parentᵀ W_j.
/// A_j, constant over the clip, is the orientation of SMPL's rest frame of j in the source's rest pose:
/// - pelvis, spine, neck, head, collars: axes to axes; chains of another length are interpolated;
/// - upper arm, forearm, thigh, shin: the shortest rotation that takes SMPL's rest bone onto the source's, composed
///   along the limb, so that limb directions agree exactly in every frame for any rest pose of the source (T-pose, arms
///   down, splayed legs);
/// - upper arm and thigh are then rotated about their own axis until elbow and knee bend in SMPL's natural plane:
///   sources choose the zero of that twist arbitrarily (CMU's elbow is 30° off), which affects the bending, not the
///   rest pose;
/// - foot: rotated about the shin until its heading agrees; its slope is relative to rest, because a flat foot is flat
///   for any height that the source gives its ankle;
/// - hand: as the limb before the twist; the forearm takes half of the hand's twist (½ sin τ), as in anatomy.
/// Positions scale by leg length (hip to ankle), and the pelvis is placed so that the mid-hips coincide. The result is
/// in a world with y up, in metres; `trans` is the pelvis joint's position (a body whose rest pelvis is not at the
/// origin is offset by it).
#pragma once

#include <array>
#include <string>

#include "data_tools/motion/skeleton_motion.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct RetargetSummary {
  double metres_per_unit = 0;
  std::array<double, 2> shoulder_twist_deg{};  ///< left, right: from the bending of the elbows; 0 if they hardly bend
  std::array<double, 2> hip_twist_deg{};
};

/// A skeleton with SMPL's own 24 joint names is copied (its rest pose is assumed to be SMPL's). Throws
/// std::runtime_error beginning with `where` when the skeleton is not a person's.
Motion RetargetToSmpl(const SkeletonMotion& source, const std::string& where, RetargetSummary* summary = nullptr);

}  // namespace bodyloom
