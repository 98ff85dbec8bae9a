// SPDX-License-Identifier: Apache-2.0
#include "geometry/biomechanics/cardan_angles.h"

#include <cmath>
#include <numbers>

#include "geometry/base/units.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kGimbalCosine = 1e-9;  // below it rounding alone decides about a and c
constexpr double kOrdinaryAngle = 75 * kDegree;

/// The angle plus the whole turns that bring it nearest to `target`.
double NearestTurn(double angle, double target) { return angle + kTurn * std::round((target - angle) / kTurn); }

Vector3d NearestTurns(const Vector3d& angles, const Vector3d& target) {
  return {NearestTurn(angles.x(), target.x()), NearestTurn(angles.y(), target.y()),
          NearestTurn(angles.z(), target.z())};
}

/// With |b| ≤ π/2. `a_at_gimbal` is taken where a is free.
Vector3d PrincipalZxy(const Matrix3d& R, double a_at_gimbal) {
  const double cosine = std::hypot(R(0, 1), R(1, 1)), b = std::atan2(R(2, 1), cosine);
  if (cosine > kGimbalCosine) return {std::atan2(-R(0, 1), R(1, 1)), b, std::atan2(-R(2, 0), R(2, 2))};
  const double sum = std::atan2(R(1, 0), R(0, 0));  // a + c at b = π/2, a − c at −π/2
  return {a_at_gimbal, b, b > 0 ? sum - a_at_gimbal : a_at_gimbal - sum};
}

}  // namespace

Vector3d CardanZxy(const Matrix3d& R, const Vector3d* before, CardanBranch branch) {
  const Vector3d principal = PrincipalZxy(R, before != nullptr ? before->x() : 0);
  if (before == nullptr) return principal;
  const Vector3d near = NearestTurns(principal, *before);
  if (branch == CardanBranch::kTurning) return {near.x(), principal.y(), near.z()};
  if (principal.cwiseAbs().maxCoeff() <= kOrdinaryAngle) return principal;
  const Vector3d other =
      NearestTurns(principal + Vector3d(0.5 * kTurn, 0.5 * kTurn - 2 * principal.y(), 0.5 * kTurn), *before);
  return (near - *before).squaredNorm() <= (other - *before).squaredNorm() ? near : other;
}

// Rᵀ = Rz(−c) Rx(−b) Ry(−a).
Vector3d CardanYxz(const Matrix3d& R, const Vector3d* before, CardanBranch branch) {
  if (before == nullptr) return -CardanZxy(R.transpose(), nullptr, branch).reverse();
  const Vector3d turned = -before->reverse();
  return -CardanZxy(R.transpose(), &turned, branch).reverse();
}

}  // namespace bodyloom
