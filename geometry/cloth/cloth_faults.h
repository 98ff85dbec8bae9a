// SPDX-License-Identifier: Apache-2.0
/// What can be wrong with cloth on a body: legs through it, depth inside the body. (Stretch: cloth_simulation.h.)
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/geometry/cloth/cloth_simulation.h"

namespace bodyloom {

/// How many legs have come through the cloth's faces: whose line from hip over knee to ankle (joints J×3) passes
/// through them an odd number of times. A leg that stays inside, or leaves by the hem, does not.
int LegsThroughCloth(const MatrixX3i& faces, const std::vector<Eigen::Vector3d>& cloth, const MatrixX3d& joints);

/// How deep the cloth lies inside the clothed body: for each vertex of the cloth the signed distance to the tangent
/// plane of the nearest point of trunk and legs, for those within 6 cm of it. Largest depth, metres (0: none inside).
double LargestDepth(const std::vector<Eigen::Vector3d>& cloth, const ClothObstacles& obstacles);

}  // namespace bodyloom
