// SPDX-License-Identifier: Apache-2.0
/// A small Gaussian prior over the poses of a hand, made from ranges and couplings alone (hand_limits.h): no recorded
/// motion, no licensed data. It says which hand is likely where nothing is seen: half closed, fingers bent alike, last
/// joints following the middle ones.
///
/// Recipe, for each of 8,192 hands: a grip g in [0, 1]; each finger closes by c = ⅓ g + ⅔ u with its own u in [0, 1].
///   MCP flexion   −10° to 80° by ½ c + ½ u′, with another u′ of the finger's own
///   PIP flexion   5° to 100° by c;  DIP ⅔ PIP, standard deviation 8°
///   radial        within ⅔ of the range, times 1 − c: closed fingers lie side by side
///   thumb         flexion of CMC, MCP and IP across ½ g + ½ u of the inner ⅘ of their ranges, radial of the CMC freely
///                 within the inner ⅘ of its range
///   the rest      0
/// Angles are clamped to the ranges, 3° are added to every standard deviation, and mean and covariance taken.
#pragma once

#include <Eigen/Core>

#include "geometry/biomechanics/hand_limits.h"

namespace bodyloom {

/// Over the angles of HandAngles().
struct HandPrior {
  HandAngleVector mean;
  /// Orthonormal principal components by falling standard deviation, as columns, and these, radians.
  Eigen::Matrix<double, kHandAngles, kHandAngles> components;
  HandAngleVector sigma;
};

/// Made once; the same on every machine.
const HandPrior& BuiltinHandPrior();

}  // namespace bodyloom
