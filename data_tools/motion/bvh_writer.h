// SPDX-License-Identifier: Apache-2.0
/// Writes a motion as BVH for animation programs: the body's joints (rest positions of the motion's shape) in
/// centimetres, y up, rotation channels Z X Y (R = Rz·Rx·Ry), degrees. Ends of chains get a short End Site. Names and
/// rest pose are those of a BvhRig.
#pragma once

#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/track.h"

namespace bodyloom {

// Skeletons of BVH files: joint names and the pose at zero rotations. All bones' axes are the world's at rest, which
// animation programs and retargeters take as their own T-pose or A-pose.

enum class BvhRig {
  kSmpl,    ///< the body's own names and all of its joints, T-pose
  kMixamo,  ///< Hips, Spine, LeftUpLeg …: Mixamo's names without "mixamorig:", T-pose; hands end at the wrist
  /// pelvis, spine_01, thigh_l …: the UE4 mannequin's names, A-pose with arms 45° down; hands end at the wrist
  kUnreal,
};
/// The names "smpl", "mixamo", "unreal".
const std::vector<std::string>& BvhRigNames();
/// Throws std::invalid_argument for other names.
BvhRig BvhRigFromString(const std::string& name);

/// The first joints of a body with the names of a rig.
struct BvhSkeleton {
  std::vector<std::string> names;  ///< of the joints kept; the others are left out
  /// World rotation of each joint of the body from its T-pose to the rig's rest pose.
  std::vector<Eigen::Matrix3d> rest_rotations;
};

/// Throws std::invalid_argument when the body does not begin with SMPL's 22 body joints (kMixamo, kUnreal).
BvhSkeleton BvhSkeletonOf(BvhRig rig, const BodyModel& model);

/// The motion may have fewer joints than the body (the others stay at rest). Motions with z up or in camera coordinates
/// are converted (motion_tools.h). BVH has a single frame time, so a motion with a gap must be resampled first. Throws
/// std::invalid_argument for such motions, std::runtime_error when the file cannot be written.
void WriteBvh(const std::string& path, const Motion& motion, const BodyModel& model, BvhRig rig = BvhRig::kSmpl);
std::string BvhText(const Motion& motion, const BodyModel& model, BvhRig rig = BvhRig::kSmpl);

}  // namespace bodyloom
