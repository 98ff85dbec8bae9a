// SPDX-License-Identifier: Apache-2.0
/// Estimates the floor of a recorded motion: its height, and whether it is flat.
///
/// A joint is above the skin's lowest point by about its clearance (measured on the built-in body: toes 1 cm, ankles 7
/// cm, …). The lowest point of a frame is min over joints of height − clearance; it supports the person if its joint
/// moves slower than 0.8 m/s, and slower than 0.2 m/s up or down. Of the heights of these support frames, the densest
/// band of 6 cm is a floor if at least 90 % of them lie within 8 cm of its median and there are at least 0.1 s of them:
/// the floor is that median. Someone who climbs, sits on a bar or walks over a heap has none; then the height is the
/// median of the support frames within 6 cm above their 5th percentile: the lowest level on which the person rests.
/// Without support frames it is the 5th percentile of the lowest points.
#pragma once

#include <span>

#include "geometry/math/arrays.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct FloorEstimate {
  double height_m = 0;     ///< of the floor, or of the lowest level, along y
  bool has_floor = false;  ///< a flat floor was found
  double flat_share = 0;   ///< share of the support frames within 8 cm of it
  double support_s = 0;    ///< time with support
};

/// Takes motions of 24 joints with y up that share one world: the pieces of one recording. Throws std::invalid_argument
/// for other motions.
FloorEstimate EstimateFloor(std::span<const Motion> pieces);

/// Height of joint j (SMPL's numbering) above the floor on which that part of the body rests, metres.
double JointClearance(int j);

/// Approximate height of the lowest point of the body's skin: min over joints of height − clearance; `joint`, when
/// given, receives that joint.
double LowestPoint(const MatrixX3d& joints, int* joint = nullptr);

}  // namespace bodyloom
