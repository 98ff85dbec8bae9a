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

inline constexpr int kHandAngles = 3 * kHandJoints;
/// The angles of a hand, 3i + k: angle k of joint i, radians.
using HandAngleVector = Eigen::Matrix<double, kHandAngles, 1>;

inline constexpr double kHandLimitSigma = 0.05;  ///< radians, of the excess over a range

/// The excess of each angle over its range by kHandLimitSigma, 0 inside. `slopes`, unless null, are the derivatives by
/// the angles themselves: 1 / kHandLimitSigma, or 0.
void HandLimitResiduals(const HandAngleVector& angles, HandAngleVector* residuals, HandAngleVector* slopes);

}  // namespace bodyloom
