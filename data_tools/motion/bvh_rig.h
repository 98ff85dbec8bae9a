// SPDX-License-Identifier: Apache-2.0
/// Which skeleton a BVH file has: names of its joints and the pose at zero rotations. All bones' axes are the world's at
/// rest, which animation programs and retargeters take for a T-pose or A-pose of their own.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/geometry/body_model.h"

namespace bodyloom {

enum class BvhRig {
  kSmpl,    ///< the body's own names and all of its joints, T-pose
  kMixamo,  ///< Hips, Spine, LeftUpLeg …: Mixamo's names without "mixamorig:", T-pose; hands end at the wrist
  kUnreal,  ///< pelvis, spine_01, thigh_l …: the UE4 mannequin's names, A-pose with arms 45° down; hands end at the wrist
};
/// "smpl", "mixamo", "unreal".
const std::vector<std::string>& BvhRigNames();
/// Throws std::invalid_argument for other names.
BvhRig BvhRigFromString(const std::string& name);

/// The first joints of a body under a rig's names.
struct BvhSkeleton {
  std::vector<std::string> names;  ///< of the joints kept; the others are left out
  /// World rotation of each joint of the body from its T-pose to the rig's rest pose.
  std::vector<Eigen::Matrix3d> rest_rotations;
};

/// Throws std::invalid_argument when the body does not begin with SMPL's 22 body joints (kMixamo, kUnreal).
BvhSkeleton BvhSkeletonOf(BvhRig rig, const BodyModel& model);

}  // namespace bodyloom
