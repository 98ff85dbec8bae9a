// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/animation_rig.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/body/hand_skeleton.h"

namespace bodyloom {
namespace {

constexpr int kRigJoints = 22;
constexpr double kArmsDown_rad = 45 * M_PI / 180;

const std::vector<std::string>& BodyJointNamesOf(AnimationRig rig) {
  static const std::vector<std::string> mixamo = {
      "Hips",      "LeftUpLeg", "RightUpLeg",  "Spine",        "LeftLeg",  "RightLeg",     "Spine1",        "LeftFoot",
      "RightFoot", "Spine2",    "LeftToeBase", "RightToeBase", "Neck",     "LeftShoulder", "RightShoulder", "Head",
      "LeftArm",   "RightArm",  "LeftForeArm", "RightForeArm", "LeftHand", "RightHand"};
  static const std::vector<std::string> unreal = {
      "pelvis",     "thigh_l",    "thigh_r",    "spine_01",   "calf_l",  "calf_r",     "spine_02",   "foot_l",
      "foot_r",     "spine_03",   "ball_l",     "ball_r",     "neck_01", "clavicle_l", "clavicle_r", "head",
      "upperarm_l", "upperarm_r", "lowerarm_l", "lowerarm_r", "hand_l",  "hand_r"};
  static const std::vector<std::string> vrm = {
      "hips",         "leftUpperLeg",  "rightUpperLeg", "spine",      "leftLowerLeg", "rightLowerLeg",
      "chest",        "leftFoot",      "rightFoot",     "upperChest", "leftToes",     "rightToes",
      "neck",         "leftShoulder",  "rightShoulder", "head",       "leftUpperArm", "rightUpperArm",
      "leftLowerArm", "rightLowerArm", "leftHand",      "rightHand"};
  return rig == AnimationRig::kMixamo ? mixamo : rig == AnimationRig::kUnreal ? unreal : vrm;
}

/// The rig's name of finger joint i of a hand (geometry/body/hand_skeleton.h).
std::string FingerNameOf(AnimationRig rig, HandSide side, int i) {
  const bool left = side == HandSide::kLeft;
  const size_t joint = size_t(i) % 3;
  std::string finger = FingerNames()[size_t(i) / 3];
  if (rig == AnimationRig::kUnreal) return finger + "_0" + std::to_string(joint + 1) + (left ? "_l" : "_r");
  if (rig == AnimationRig::kVrm && finger == "pinky") finger = "little";
  finger[0] = static_cast<char>(finger[0] - 'a' + 'A');
  if (rig == AnimationRig::kMixamo) return (left ? "LeftHand" : "RightHand") + finger + std::to_string(joint + 1);
  static constexpr std::array<const char*, 3> kFinger = {"Proximal", "Intermediate", "Distal"},
                                              kThumb = {"Metacarpal", "Proximal", "Distal"};
  return (left ? "left" : "right") + finger + (finger == "Thumb" ? kThumb[joint] : kFinger[joint]);
}

}  // namespace

const std::vector<std::string>& AnimationRigNames() {
  static const std::vector<std::string> names = {"smpl", "mixamo", "unreal", "vrm"};
  return names;
}

AnimationRig AnimationRigFromString(const std::string& name) {
  const auto found = std::find(AnimationRigNames().begin(), AnimationRigNames().end(), name);
  BODYLOOM_CHECK(found != AnimationRigNames().end(), "rig '", name, "', expected smpl, mixamo, unreal or vrm");
  return static_cast<AnimationRig>(found - AnimationRigNames().begin());
}

RigSkeleton RigSkeletonOf(AnimationRig rig, const BodyModel& model) {
  RigSkeleton skeleton;
  skeleton.rest_rotations.assign(size_t(model.num_joints()), Eigen::Matrix3d::Identity());
  if (rig == AnimationRig::kSmpl) {
    skeleton.names = model.data().joint_names;
    return skeleton;
  }
  bool smpl = model.num_joints() >= kRigJoints;
  for (int j = 0; smpl && j < kRigJoints; ++j) smpl = model.parents()[j] == SmplParents()[size_t(j)];
  BODYLOOM_CHECK(smpl, "rig: the body '", model.name(),
                 "' does not begin with SMPL's 22 body joints, which the rig needs");
  skeleton.names = BodyJointNamesOf(rig);
  if (HasFingers(model)) {
    skeleton.names.insert(skeleton.names.end(), model.data().joint_names.begin() + kRigJoints,
                          model.data().joint_names.end());
    for (const HandSide side : {HandSide::kLeft, HandSide::kRight}) {
      for (int i = 0; i < kHandJoints; ++i) {
        skeleton.names[size_t(model.FindJoint(HandJointNames(side)[size_t(i)]))] = FingerNameOf(rig, side, i);
      }
    }
  }
  if (rig != AnimationRig::kUnreal) return skeleton;
  // The left arm points along +x: down is a turn about −z.
  const Eigen::Matrix3d left = Eigen::AngleAxisd(-kArmsDown_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (int side = 0; side < 2; ++side) {
    for (const int joint : {16, 18, 20})
      skeleton.rest_rotations[static_cast<size_t>(joint) + static_cast<size_t>(side)] =
          side == 0 ? left : left.transpose();
  }
  for (size_t j = kRigJoints; j < skeleton.rest_rotations.size(); ++j) {
    skeleton.rest_rotations[j] = skeleton.rest_rotations[size_t(model.parents()[int(j)])];
  }
  return skeleton;
}

Eigen::Matrix3d RigSkeleton::FromRest(const BodyModel& model, const BodyPose& pose, int j) const {
  const int parent = model.parents()[j];
  const Eigen::Matrix3d turned = pose.rotations[j] * rest_rotations[j].transpose();
  return parent < 0 ? turned : rest_rotations[parent] * turned;
}

MatrixX3d RigSkeleton::RestPositions(const BodyModel& model, const MatrixX3d& t_pose_joints) const {
  MatrixX3d positions = t_pose_joints;
  for (int j = 1; j < model.num_joints(); ++j) {
    const int parent = model.parents()[j];
    positions.row(j) =
        positions.row(parent) + (t_pose_joints.row(j) - t_pose_joints.row(parent)) * rest_rotations[parent].transpose();
  }
  return positions;
}

}  // namespace bodyloom
