// SPDX-License-Identifier: Apache-2.0
/// Skeletons of animation programs, for BVH and FBX: joint names and the pose at zero rotations. All bones' axes are
/// the world's at rest, which animation programs and retargeters take as their own T-pose or A-pose.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"

namespace bodyloom {

enum class AnimationRig {
  kSmpl,    ///< the body's own names, T-pose
  kMixamo,  ///< Hips, Spine, LeftUpLeg …: Mixamo's names without "mixamorig:", T-pose
  kUnreal,  ///< pelvis, spine_01, thigh_l …: names of Unreal's UE4 and UE5 mannequins, A-pose with arms 45° down
  kVrm,     ///< hips, spine, leftUpperLeg …: humanoid bones of VRM 1.0, T-pose
};
/// The names "smpl", "mixamo", "unreal", "vrm".
const std::vector<std::string>& AnimationRigNames();
/// Throws std::invalid_argument for other names.
AnimationRig AnimationRigFromString(const std::string& name);

/// A body's joints in the form of a rig.
struct RigSkeleton {
  /// Of the body's first joints: all of them (kSmpl, and bodies with fingers, whose joints these rigs have names for;
  /// SMPL-X's jaw and eyes keep theirs), or SMPL's 22 body joints.
  std::vector<std::string> names;
  /// World rotation A of each joint of the body from its T-pose to the rig's rest pose. Joints beyond the names turn
  /// with their parents.
  std::vector<Eigen::Matrix3d> rest_rotations;

  /// Local rotation of joint j in the rig: A_p R Aᵀ with the pose's R and the parent's A_p (identity for the root).
  [[nodiscard]] Eigen::Matrix3d FromRest(const BodyModel& model, const BodyPose& pose, int j) const;
  /// J×3 joints in the rig's rest pose, from those of the T-pose: the root stays, bones turn by their parents' A.
  [[nodiscard]] MatrixX3d RestPositions(const BodyModel& model, const MatrixX3d& t_pose_joints) const;
};

/// Throws std::invalid_argument when the body does not begin with SMPL's 22 body joints (all rigs but kSmpl).
RigSkeleton RigSkeletonOf(AnimationRig rig, const BodyModel& model);

}  // namespace bodyloom
