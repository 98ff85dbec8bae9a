// SPDX-License-Identifier: Apache-2.0
/// The 21 points of a hand as a function of 20 coordinates of its fingers.
///
/// Free angles (HandAngles(), geometry/biomechanics/hand_limits.h) are flexion and sideways angle of the knuckles and
/// flexion of the joints beyond them; of the thumb flexion and radial angle of the CMC and flexion of MCP and IP. The
/// others are 0. Coordinates y are those along the principal components of the hand prior over the free angles, in
/// standard deviations:
///   angles = mean + L y,   L Lᵀ = the prior's covariance of the free angles
/// so that the prior is ½ |y|², and a step in time couples each coordinate with itself alone. The hand is a tree of
/// rigid bones at the joints of the shaped body; a tip is fixed to the last bone, where the body's landmark lies at
/// rest.
#pragma once

#include <Eigen/Core>
#include <array>

#include "geometry/biomechanics/hand_limits.h"
#include "geometry/body/body_model.h"
#include "geometry/body/hand_skeleton.h"

namespace bodyloom {

inline constexpr int kFingerCoordinates = 20;
using FingerCoordinates = Eigen::Matrix<double, kFingerCoordinates, 1>;
/// ∂(a place or a direction)/∂y.
using ByFingers = Eigen::Matrix<double, 3, kFingerCoordinates>;

/// Indices of the free angles in HandAngleVector.
const std::array<int, kFingerCoordinates>& FreeHandAngles();

class HandKinematics {
 public:
  /// `betas` may be shorter than the body's.
  HandKinematics(const BodyModel& body, const HandSkeleton& hand, const Eigen::VectorXd& betas);

  /// Metres from the wrist to point k (HandLandmarkNames()), in the axes of the wrist joint. `by_fingers` may be null.
  [[nodiscard]] Eigen::Vector3d Point(int k, const FingerCoordinates& y, ByFingers* by_fingers) const;
  [[nodiscard]] HandAngleVector Angles(const FingerCoordinates& y) const;
  /// Those of the nearest pose without the angles that are not free.
  [[nodiscard]] FingerCoordinates CoordinatesOf(const HandAngleVector& angles) const;
  /// ∂(free angles)/∂y = L.
  [[nodiscard]] const Eigen::Matrix<double, kFingerCoordinates, kFingerCoordinates>& by_coordinates() const {
    return L_;
  }
  [[nodiscard]] const HandSkeleton& hand() const { return hand_; }
  /// Of the shaped hand from the wrist to the knuckle of the middle finger, metres.
  [[nodiscard]] double length_m() const { return bone_[1][0].norm(); }

 private:
  HandSkeleton hand_;
  /// Of each finger, as FingerNames(): from the wrist to joint 1, on to joints 2 and 3, and to the tip.
  std::array<std::array<Eigen::Vector3d, 4>, 5> bone_;
  FingerCoordinates mean_;
  Eigen::Matrix<double, kFingerCoordinates, kFingerCoordinates> L_, inverse_;
};

/// The joint (HandJointNames()) at a point, −1 for the wrist and tips.
int HandJointAt(int point);

}  // namespace bodyloom
