// SPDX-License-Identifier: Apache-2.0
/// Sends a body's pose over UDP by the Virtual Motion Capture protocol (OSC), which programs for avatars read, and
/// Blender, Unity and Unreal with their add-ons.
///
/// For each frame, in bundles of at most 1,200 bytes:
///   /VMC/Ext/OK        loaded 1, calibration state 3, calibration mode 0, tracking 1 (the person is seen) or 0
///   /VMC/Ext/T         seconds
///   /VMC/Ext/Root/Pos  "root" at the origin, not turned
///   /VMC/Ext/Bone/Pos  name, position x y z, rotation x y z w: each of VmcBones()
/// Without a pose only the first two. Nothing is waited for: whether somebody receives it stays unknown.
/// Source: VMC protocol specification (protocol.vmc.info), performer.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"

namespace bodyloom {

// A posed body as the bones of Unity's humanoid avatars, for the Virtual Motion Capture protocol (VMC).
//
//   Hips Spine Chest UpperChest Neck Head       pelvis spine1 spine2 spine3 neck head
//   LeftUpperLeg LeftLowerLeg LeftFoot LeftToes     l_hip l_knee l_ankle l_foot, and so the right ones
//   LeftShoulder LeftUpperArm LeftLowerArm LeftHand l_collar l_shoulder l_elbow l_wrist
//   LeftIndexProximal Intermediate Distal …         l_index1 2 3; Middle, Ring, Little (pinky) and Thumb likewise
// Joints that the body lacks are left out. Unity's frame is left-handed: x right, y up, z ahead of a figure that looks
// along it. Ours (x to the figure's left, y up, z ahead) is mirrored at x = 0:
//   (x, y, z) → (−x, y, z),   quaternion (x, y, z, w) → (x, −y, −z, w)
// Rotations are local, and the identity in T-pose, as those of VRM's normalised bones. A bone's position is its
// joint's, relative to its parent's in the parent's axes; that of Hips is in the world, relative to `origin`.
// Source: VMC protocol specification (protocol.vmc.info), performer; Unity, HumanBodyBones.

struct VmcBone {
  std::string name;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();            ///< Unity's axes, metres
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< likewise; w ≥ 0
};

/// Mirrors at x = 0 into Unity's frame.
Eigen::Vector3d UnityPosition(const Eigen::Vector3d& point);
/// The same for a rotation; w ≥ 0.
Eigen::Quaterniond UnityRotation(const Eigen::Matrix3d& rotation);

/// The bones of a body posed in a world with y up (PoseInWorld()); `rest_joints` J×3 of its shape. `origin`: a point
/// of the world that becomes Unity's origin. Throws std::invalid_argument when sizes are not the body's.
std::vector<VmcBone> VmcBones(const BodyModel& body, const MatrixX3d& rest_joints, const BodyPose& pose_in_world,
                              const Eigen::Vector3d& origin);

class VmcSender {
 public:
  /// `address`: HOST:PORT, port 1 to 65535. Throws std::invalid_argument for another form, std::runtime_error naming a
  /// host that is not known.
  explicit VmcSender(const std::string& address);
  ~VmcSender();
  VmcSender(const VmcSender&) = delete;
  VmcSender& operator=(const VmcSender&) = delete;

  /// `bones`: empty when there is no pose.
  void Send(double seconds, bool tracked, const std::vector<VmcBone>& bones);

 private:
  class Target;
  std::unique_ptr<Target> target_;
};

}  // namespace bodyloom
