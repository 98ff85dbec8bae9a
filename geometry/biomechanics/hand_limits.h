// SPDX-License-Identifier: Apache-2.0
/// Ranges of the finger joints, and residuals for poses outside of them.
///
/// Angles of a joint are the components of its axis-angle along its axes (flexion, radial, twist;
/// geometry/body/hand_skeleton.h), the flexion counted from a straight hand:
///   a = Aᵀ log(R) + (rest_flexion, 0, 0)
/// Fingers' middle and last joints and the thumb's last are hinges. Their last joints are bent by the tendon that bends
/// the middle ones: DIP ≈ ⅔ PIP.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "geometry/body/hand_skeleton.h"

namespace bodyloom {

struct AngleRange {
  double low = 0, high = 0;  ///< radians
};

struct FingerJointRange {
  AngleRange flexion, radial, twist;
};

/// By joint, in SMPL-H's order, the same for both hands: adults' active ranges, to the passive limit where objects
/// press fingers back. Hinges have 3° to either side for bodies whose axes are not exactly those.
/// Sources: American Academy of Orthopaedic Surgeons, "Joint Motion", 1965 (MCP 0–90, hyperextended to 45, PIP 0–100,
/// DIP 0–90; thumb: MCP 0–50, IP 0–80, CMC flexion 15, extension 20, abduction 70); Lin, Wu and Huang, "Modeling the
/// Constraints of Human Hand Motion", 2000 (PIP 110, abduction 15).
const std::array<FingerJointRange, kHandJoints>& HandJointRanges();

/// DIP flexion for a PIP flexion of 1. Source: Rijpkema and Girard, "Computer Animation of Knowledge-based Human
/// Grasping", 1991.
inline constexpr double kDipByPip = 2.0 / 3;

/// The three angles of joint i of a hand, radians.
Eigen::Vector3d HandAngles(const HandSkeleton& hand, int i, const Eigen::Matrix3d& R);
/// Its inverse.
Eigen::Matrix3d HandRotation(const HandSkeleton& hand, int i, const Eigen::Vector3d& angles);

struct HandLimitOptions {
  double sigma_rad = 0.05;          ///< of the excess over a range
  double coupling_sigma_rad = 0.2;  ///< of DIP − ⅔ PIP; people can hold it 10° off
};

/// Rows 3i + k: angle k of joint i beyond its range by sigma; rows 45 to 48: DIP − ⅔ PIP of index, middle, pinky and
/// ring finger, by coupling_sigma.
inline constexpr int kHandLimitRows = 3 * kHandJoints + 4;

/// `rotations`: 15 local ones, in the hand's order. `residuals` has kHandLimitRows entries. `jacobian`, unless null, is
/// their derivative by right increments R exp(δ), columns 3i to 3i + 2 for joint i. Throws std::invalid_argument for
/// another number of rotations.
void HandLimitResiduals(const HandSkeleton& hand, std::span<const Eigen::Matrix3d> rotations,
                        const HandLimitOptions& options, Eigen::Matrix<double, kHandLimitRows, 1>* residuals,
                        Eigen::Matrix<double, kHandLimitRows, 3 * kHandJoints>* jacobian);

}  // namespace bodyloom
