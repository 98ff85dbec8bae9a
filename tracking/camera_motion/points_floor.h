// SPDX-License-Identifier: Apache-2.0
/// Finds the floor among points of the background of a moving camera (CameraMotion::points).
///
/// The floor is the plane {x : up · x = −height}, the origin being above it. Candidates are planes through three points
/// (300 samples, the same ones every time) whose normal is within 20° of the expected up; score: Σ (1 − (e/τ)²) over
/// e < τ, e = |up · x + height| / |x|, τ = 0.02, because a point's depth is known to a share of its distance. A table
/// has points below it: a candidate with more than a third as many points below it as on it is not taken. The best is
/// refined by reweighted least squares of e (Geman–McClure, c = 3 robust σ).
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

namespace bodyloom {

struct PointsFloor {
  bool found = false;
  std::string why;                                 ///< the evidence, or the reason why none was found
  Eigen::Vector3d up = Eigen::Vector3d(0, -1, 0);  ///< unit
  double height = 0;                               ///< of the origin above the floor, in the points' units
  int points = 0;                                  ///< on it
  /// Of the plane's error at a place p, J C Jᵀ with J = (a·p, b·p, 1): turns of `up` towards a and b, height.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Eigen::Vector3d a = Eigen::Vector3d::UnitX(), b = Eigen::Vector3d::UnitZ();  ///< unit, across `up`

  /// Height of a place above the floor, units.
  [[nodiscard]] double HeightOf(const Eigen::Vector3d& place) const { return up.dot(place) + height; }
  /// Its standard deviation, by the plane's.
  [[nodiscard]] double SigmaAt(const Eigen::Vector3d& place) const;
  /// Root mean square of the standard deviation over the directions across `up`, rad.
  [[nodiscard]] double UpSigma() const;
};

/// `expected_up`: unit. Found with 20 points on it and a σ of `up` of at most 3°.
PointsFloor FindPointsFloor(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& expected_up);

}  // namespace bodyloom
