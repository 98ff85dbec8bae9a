// SPDX-License-Identifier: Apache-2.0
/// Cardan angles of rotations, continuous over time.
#pragma once

#include <Eigen/Core>

namespace bodyloom {

/// Choice between the two triples (a, b, c) and (a + π, π − b, c + π) of one rotation.
enum class CardanBranch {
  /// |b| ≤ π/2 always; a and c follow the frame before by whole turns without limit. For a body that turns in a room.
  kTurning,
  /// A joint, which cannot wind up: the triple with |b| ≤ π/2, each angle in (−π, π], if none is above 75°; otherwise
  /// the triple nearest to the frame before, so that an arm that is lifted sideways beyond the horizontal goes on
  /// from −90° of adduction.
  kJoint,
};

/// Angles (a, b, c), radians, with R = Rz(a) Rx(b) Ry(c), each about the axes that the ones before it have turned.
/// `before`: the angles of the frame before; null: there is none, and the triple with |b| ≤ π/2 is taken. At
/// |b| = π/2, where a ± c alone is determined, a is that of the frame before (0 without one). Near there small errors
/// of R become large ones of a and c, but the three angles always give R. R must be a rotation.
Eigen::Vector3d CardanZxy(const Eigen::Matrix3d& R, const Eigen::Vector3d* before = nullptr,
                          CardanBranch branch = CardanBranch::kJoint);

/// The same with R = Ry(a) Rx(b) Rz(c).
Eigen::Vector3d CardanYxz(const Eigen::Matrix3d& R, const Eigen::Vector3d* before = nullptr,
                          CardanBranch branch = CardanBranch::kJoint);

}  // namespace bodyloom
