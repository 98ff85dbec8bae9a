// SPDX-License-Identifier: Apache-2.0
/// Lines of the body that keep their length, as an image shows them, and turns that nobody can make.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/scene/observations.h"

namespace bodyloom {

/// Projections of three lines, of T frames, divided by their lengths in the image: vectors of length 1 where a line is
/// seen from the side, 0 where it points along the line of sight; NaN where an end is not seen.
/// A trunk's length is the largest of its projections within a second. Those of shoulders and hips are in proportion to
/// it: the ninetieth percentile over the clip, at least 0.5 and 0.3 trunks (people are about 0.7 and 0.4).
struct BodyRods {
  /// From the middle of the hips to that of the shoulders; of a pair of which one is seen, from or to that.
  std::vector<Eigen::Vector2d> trunk;
  std::vector<Eigen::Vector2d> shoulders, hips;  ///< from right to left
};

/// For landmarks named left_shoulder, left_hip and so on; all NaN without them.
BodyRods FindBodyRods(const KeypointSequence& keypoints);

/// Smallest angle, radians, between two directions in space with projections a and b of BodyRods:
/// acos(a·b + √(1 − |a|²) √(1 − |b|²)); longer projections count as 1. NaN where one is NaN.
double SmallestTurn(const Eigen::Vector2d& a, const Eigen::Vector2d& b);

/// Speeds that people do not reach, radians a second: of shoulders and hips (five spins a second, as the fastest
/// skaters make), and of the trunk (three turns a second, as in the fastest somersaults).
inline constexpr double kFasterThanSpins = 30, kFasterThanSomersaults = 20;

}  // namespace bodyloom
