// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/motion/bvh_rig.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int kRigJoints = 22;
constexpr double kArmsDown_rad = 45 * M_PI / 180;

}  // namespace

const std::vector<std::string>& BvhRigNames() {
  static const std::vector<std::string> names = {"smpl", "mixamo", "unreal"};
  return names;
}

BvhRig BvhRigFromString(const std::string& name) {
  const auto found = std::find(BvhRigNames().begin(), BvhRigNames().end(), name);
  BODYLOOM_CHECK(found != BvhRigNames().end(), "rig '", name, "', expected smpl, mixamo or unreal");
  return static_cast<BvhRig>(found - BvhRigNames().begin());
}

BvhSkeleton BvhSkeletonOf(BvhRig rig, const BodyModel& model) {
  static const std::vector<std::string> mixamo = {
      "Hips",      "LeftUpLeg", "RightUpLeg",  "Spine",        "LeftLeg",  "RightLeg",     "Spine1",        "LeftFoot",
      "RightFoot", "Spine2",    "LeftToeBase", "RightToeBase", "Neck",     "LeftShoulder", "RightShoulder", "Head",
      "LeftArm",   "RightArm",  "LeftForeArm", "RightForeArm", "LeftHand", "RightHand"};
  static const std::vector<std::string> unreal = {
      "pelvis",     "thigh_l",    "thigh_r",    "spine_01",   "calf_l",  "calf_r",     "spine_02",   "foot_l",
      "foot_r",     "spine_03",   "ball_l",     "ball_r",     "neck_01", "clavicle_l", "clavicle_r", "head",
      "upperarm_l", "upperarm_r", "lowerarm_l", "lowerarm_r", "hand_l",  "hand_r"};
  BvhSkeleton skeleton;
  skeleton.rest_rotations.assign(size_t(model.num_joints()), Eigen::Matrix3d::Identity());
  if (rig == BvhRig::kSmpl) {
    skeleton.names = model.data().joint_names;
    return skeleton;
  }
  bool smpl = model.num_joints() >= kRigJoints;
  for (int j = 0; smpl && j < kRigJoints; ++j) smpl = model.parents()[j] == SmplParents()[size_t(j)];
  BODYLOOM_CHECK(smpl, "BVH: the body '", model.name(),
                 "' does not begin with SMPL's 22 body joints, which the rig needs");
  skeleton.names = rig == BvhRig::kMixamo ? mixamo : unreal;
  if (rig != BvhRig::kUnreal) return skeleton;
  // The left arm points along +x: down is a turn about −z.
  const Eigen::Matrix3d left = Eigen::AngleAxisd(-kArmsDown_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (int side = 0; side < 2; ++side) {
    for (const int joint : {16, 18, 20})
      skeleton.rest_rotations[static_cast<size_t>(joint) + static_cast<size_t>(side)] =
          side == 0 ? left : left.transpose();
  }
  return skeleton;
}

}  // namespace bodyloom
