// SPDX-License-Identifier: Apache-2.0
/// Carries the motion of any humanoid skeleton over to SMPL's 24 joints.
///
/// Every SMPL joint j follows a source joint s (skeleton_map.h) by its world rotation:
///   W_j(t) = file_from_bodyᵀ · W_s(t) · A_j,   θ_j = W_parentᵀ W_j.
/// A_j, constant over the clip, says where SMPL's rest frame of j lies in the source's rest pose:
/// - pelvis, spine, neck, head, collars: axes to axes; chains of another length are interpolated;
/// - upper arm, forearm, thigh, shin: the shortest turn that takes SMPL's rest bone onto the source's, composed along
///   the limb, so that limb directions agree exactly in every frame whatever the source's rest pose (T-pose, arms down,
///   splayed legs);
/// - upper arm and thigh are then turned about their own axis until elbow and knee bend in SMPL's natural plane:
///   sources put the zero of that twist anywhere (CMU's elbow is 30° off), and it shows in how the limb bends, not at
///   rest;
/// - foot: turned about the shin until its heading agrees; its slope is rest to rest, because flat is flat whatever
///   height the source gives its ankle;
/// - hand: as the limb before the twist; the forearm takes half of the hand's twist (½ sin τ), as flesh does.
/// Positions scale by leg length (hip to ankle), and the pelvis is placed so that the middles of the hips coincide. The
/// result is a world with y up in metres; `trans` is the pelvis joint's position (a body whose rest pelvis is not at
/// the origin stands offset by it).
#pragma once

#include <array>
#include <string>

#include "data_tools/motion/skeleton_motion.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct RetargetSummary {
  double metres_per_unit = 0;
  std::array<double, 2> shoulder_twist_deg{};  ///< left, right: found from how the elbows bend; 0 when they hardly do
  std::array<double, 2> hip_twist_deg{};
};

/// A skeleton with SMPL's own 24 joint names is copied as it is (its rest pose is taken for SMPL's). Throws
/// std::runtime_error beginning with `where` when the skeleton is not a person's.
Motion RetargetToSmpl(const SkeletonMotion& source, const std::string& where, RetargetSummary* summary = nullptr);

}  // namespace bodyloom
