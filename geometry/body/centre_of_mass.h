// SPDX-License-Identifier: Apache-2.0
/// Centre of mass of a body from its joints, and the point of the ground about which it balances.
///
/// The body is 14 segments. Each has a share of the body's mass, and its centre lies on the line between two places of
/// the skeleton, so the centre of mass is linear in the joints: c = Σ_j share_j · joint_j, Σ_j share_j = 1.
///
/// Shares and places: de Leva, "Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters", J. Biomechanics 29
/// (1996), table 4, mean of men and women. Its ends are joint centres where SMPL has them (trunk from the middle of the
/// shoulders to that of the hips, arms, thighs, shanks). For the others:
///   head  its centre is 12 cm above the 7th cervical vertebra, where SMPL's "neck" lies; "head" is 10 cm above that
///   hand  63 mm beyond the wrist: 0.24 of the forearm, in line with it
///   foot  42 % of the way from heel to toe, 0.4 of the way from "ankle" to "foot"
/// A spine that bends by 60° leaves the trunk's centre 4 cm beside its line, which moves c by 2 cm.
#pragma once

#include <Eigen/Core>
#include <span>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

inline constexpr double kGravity = 9.81;  ///< m/s²

/// A segment between two places of the skeleton, each the middle of two joints (twice the same for one joint).
struct SegmentMass {
  const char* name;
  const char* from[2];
  const char* to[2];
  double share;  ///< of the body's mass
  double along;  ///< centre = (1 − along) · from + along · to
};

/// The 14 segments, by names of SMPL's joints (SmplJointNames()). The shares sum to 1.
std::span<const SegmentMass> SegmentMasses();

/// Share of each joint in the centre of mass (J, sum 1; some are negative). Empty when the body lacks a joint of the
/// table.
Eigen::VectorXd MassByJoint(const BodyModel& body);

/// c = Σ_j share_j · joint_j in the frame of the joints (J×3). Throws std::invalid_argument when the sizes differ.
Eigen::Vector3d CentreOfMass(const MatrixX3d& joints, const Eigen::VectorXd& mass_by_joint);

/// Zero-moment point on the ground y = 0 of a world whose y is up, (x, z) in metres:
///   p = c_h − c_v / (g + a_v) · a_h
/// for the centre of mass c and its acceleration a (m/s²); h: x and z, v: y. A body without angular momentum is
/// supported there: at rest straight below c. NaN in free fall (g + a_v ≤ 0), where nothing supports it.
Eigen::Vector2d ZeroMomentPoint(const Eigen::Vector3d& centre_of_mass, const Eigen::Vector3d& acceleration);

/// Rise of the centre of mass of a body that left the ground `since_s` ago and returns in `until_s`, metres:
/// ½ g · since · until. Points of the surface rise by no more, save for how the limbs are drawn up.
inline double RiseInFlight(double since_s, double until_s) { return 0.5 * kGravity * since_s * until_s; }

}  // namespace bodyloom
