// SPDX-License-Identifier: Apache-2.0
#include "geometry/biomechanics/hand_limits.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
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

void HandLimitResiduals(const HandSkeleton& hand, std::span<const Matrix3d> rotations, const HandLimitOptions& options,
                        Eigen::Matrix<double, kHandLimitRows, 1>* residuals,
                        Eigen::Matrix<double, kHandLimitRows, 3 * kHandJoints>* jacobian) {
  BODYLOOM_CHECK(rotations.size() == kHandJoints, "hand limits: ", rotations.size(), " rotations, expected ",
                 kHandJoints);
  residuals->setZero();
  if (jacobian != nullptr) jacobian->setZero();
  std::array<double, kHandJoints> flexion{};
  std::array<Eigen::RowVector3d, kHandJoints> d_flexion;
  for (int i = 0; i < kHandJoints; ++i) {
    const Matrix3d& R = rotations[size_t(i)];
    const Vector3d angles = HandAngles(hand, i, R);
    Matrix3d d_angles = Matrix3d::Zero();
    if (jacobian != nullptr) {
      d_angles = hand.axes[size_t(i)].transpose() * RightJacobianInverse(AxisAngleFromRotation(R));
    }
    flexion[size_t(i)] = angles[0];
    d_flexion[size_t(i)] = d_angles.row(0);
    const FingerJointRange& range = HandJointRanges()[size_t(i)];
    const std::array<AngleRange, 3> by_axis = {range.flexion, range.radial, range.twist};
    for (int k = 0; k < 3; ++k) {
      const double inside = std::clamp(angles[k], by_axis[size_t(k)].low, by_axis[size_t(k)].high);
      if (angles[k] == inside) continue;
      (*residuals)[3 * i + k] = (angles[k] - inside) / options.sigma_rad;
      if (jacobian != nullptr) jacobian->block<1, 3>(3 * i + k, 3 * i) = d_angles.row(k) / options.sigma_rad;
    }
  }
  for (int f = 0; f < kThumbOfHand; ++f) {
    const int row = 3 * kHandJoints + f;
    const auto pip = size_t(3 * f + 1), dip = size_t(3 * f + 2);
    (*residuals)[row] = (flexion[dip] - kDipByPip * flexion[pip]) / options.coupling_sigma_rad;
    if (jacobian == nullptr) continue;
    jacobian->block<1, 3>(row, 3 * f * 3 + 6) = d_flexion[dip] / options.coupling_sigma_rad;
    jacobian->block<1, 3>(row, 3 * f * 3 + 3) = -kDipByPip * d_flexion[pip] / options.coupling_sigma_rad;
  }
}

}  // namespace bodyloom
