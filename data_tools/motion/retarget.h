// SPDX-License-Identifier: Apache-2.0
/// Retargets the motion of any humanoid skeleton to SMPL's 24 joints.
///
/// Every SMPL joint j follows a source joint s (FindSmplSources()) by its world rotation:
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

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

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

// Joint map of a foreign skeleton: identifies its hips, knees, elbows, …
//
// Knees, ankles, toes, elbows, wrists and the head are found by name (the vocabularies of CMU, Mixamo, Acclaim, Biped,
// DeepMimic, AMP, SMPL); the rest by topology, because their names differ between vocabularies ("LeftShoulder" is a
// clavicle in one and an upper arm in another): a shoulder is an elbow's parent, a hip a knee's parent, the chest is
// where the two arms meet, the pelvis where the two legs meet.

/// Indices into the skeleton's joints; −1 for missing ones. Sides: 0 left, 1 right.
struct SkeletonMap {
  int pelvis = -1;
  std::array<int, 2> hip{-1, -1}, knee{-1, -1}, ankle{-1, -1}, toe{-1, -1};
  std::array<int, 2> collar{-1, -1}, shoulder{-1, -1}, elbow{-1, -1}, wrist{-1, -1};
  std::array<int, 2> palm{-1, -1};  ///< carries the hand's orientation: the wrist, or a joint beyond it
  std::vector<int> spine;           ///< from above the pelvis to the chest; may be empty
  std::vector<int> neck;            ///< from above the chest to the head
  /// File axes from body axes (x left, y up, z front) at rest: a permutation of axes with signs.
  Eigen::Matrix3d file_from_body = Eigen::Matrix3d::Identity();
};

/// Throws std::runtime_error beginning with `where` that names the missing joint and those present.
SkeletonMap MapSkeleton(const SkeletonMotion& motion, const std::string& where);

}  // namespace bodyloom
