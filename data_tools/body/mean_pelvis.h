// SPDX-License-Identifier: Apache-2.0
/// Where the published bodies have their pelvis: their `trans` is not the pelvis's place but its place less this.
#pragma once

#include <Eigen/Core>
#include <string>

namespace bodyloom {

/// The pelvis joint of the mean neutral shape at rest, metres, about which the root turns ("smpl", "smplx"). Throws
/// std::invalid_argument for another body. Shapes move it by a few centimetres.
Eigen::Vector3d MeanPelvis(const std::string& body);

}  // namespace bodyloom
