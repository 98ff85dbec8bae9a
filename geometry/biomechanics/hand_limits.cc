// SPDX-License-Identifier: Apache-2.0
#include "geometry/biomechanics/hand_limits.h"

#include <algorithm>
#include <cmath>

#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kThumbOfHand = 4;  // in FingerNames()

AngleRange Degrees(double low, double high) { return {low * M_PI / 180, high * M_PI / 180}; }

std::array<FingerJointRange, kHandJoints> MakeHandJointRanges() {
  std::array<FingerJointRange, kHandJoints> ranges;
  // Index, middle, pinky, ring: the middle finger is the axis of abduction and moves least.
  constexpr std::array<double, 4> kSideways_deg = {22, 15, 27, 18};
  for (int f = 0; f < kThumbOfHand; ++f) {
    const double side = kSideways_deg[size_t(f)];
    ranges[size_t(3 * f)] = {Degrees(-30, 95), Degrees(-side, side), Degrees(-8, 8)};
    ranges[size_t(3 * f + 1)] = {Degrees(-8, 110), Degrees(-3, 3), Degrees(-3, 3)};
    ranges[size_t(3 * f + 2)] = {Degrees(-10, 85), Degrees(-3, 3), Degrees(-3, 3)};
  }
  ranges[12] = {Degrees(-25, 35), Degrees(-20, 60), Degrees(-25, 25)};
  ranges[13] = {Degrees(-15, 65), Degrees(-12, 12), Degrees(-10, 10)};
  ranges[14] = {Degrees(-20, 85), Degrees(-3, 3), Degrees(-3, 3)};
  return ranges;
}

}  // namespace

const std::array<FingerJointRange, kHandJoints>& HandJointRanges() {
  static const std::array<FingerJointRange, kHandJoints> ranges = MakeHandJointRanges();
  return ranges;
}

Vector3d HandAngles(const HandSkeleton& hand, int i, const Matrix3d& R) {
  const auto joint = size_t(i);
  return hand.axes.at(joint).transpose() * AxisAngleFromRotation(R) + Vector3d(hand.rest_flexion[joint], 0, 0);
}

Matrix3d HandRotation(const HandSkeleton& hand, int i, const Vector3d& angles) {
  const auto joint = size_t(i);
  return RotationFromAxisAngle(hand.axes.at(joint) * (angles - Vector3d(hand.rest_flexion[joint], 0, 0)));
}

void HandLimitResiduals(const HandAngleVector& angles, HandAngleVector* residuals, HandAngleVector* slopes) {
  for (int i = 0; i < kHandJoints; ++i) {
    const FingerJointRange& range = HandJointRanges()[size_t(i)];
    const std::array<AngleRange, 3> by_axis = {range.flexion, range.radial, range.twist};
    for (int k = 0; k < 3; ++k) {
      const double angle = angles[3 * i + k],
                   inside = std::clamp(angle, by_axis[size_t(k)].low, by_axis[size_t(k)].high);
      (*residuals)[3 * i + k] = (angle - inside) / kHandLimitSigma;
      if (slopes != nullptr) (*slopes)[3 * i + k] = angle == inside ? 0 : 1 / kHandLimitSigma;
    }
  }
}

}  // namespace bodyloom
