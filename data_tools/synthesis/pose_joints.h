// SPDX-License-Identifier: Apache-2.0
/// SMPL's joints by name.
#pragma once

#include <array>

namespace bodyloom {

inline constexpr int kPoseJoints = 24;

enum PoseJoint : int {
  kPelvis = 0,
  kLeftHip = 1,
  kSpine1 = 3,
  kLeftKnee = 4,
  kSpine2 = 6,
  kLeftAnkle = 7,
  kSpine3 = 9,
  kLeftFoot = 10,
  kNeck = 12,
  kLeftCollar = 13,
  kHead = 15,
  kLeftShoulder = 16,
  kLeftElbow = 18,
  kLeftWrist = 20,
  kLeftHand = 22,
};  // right = left + 1

/// The joint on the other side.
inline int MirrorJoint(int joint) {
  static constexpr std::array<int, kPoseJoints> kMirror = {0,  2,  1,  3,  5,  4,  6,  8,  7,  9,  11, 10,
                                                           12, 14, 13, 15, 17, 16, 19, 18, 21, 20, 23, 22};
  return kMirror[joint];
}

}  // namespace bodyloom
