// SPDX-License-Identifier: Apache-2.0
/// The light that a synthetic person stands in.
#pragma once

#include <Eigen/Core>
#include <array>

namespace bodyloom {

/// A surface of normal n shows its colour, of the picture's own numbers, times ambient + Σ strength · max(0, n·towards).
struct PersonLight {
  float ambient = 0.45F;
  std::array<Eigen::Vector3f, 2> towards = {Eigen::Vector3f::UnitY(),
                                            Eigen::Vector3f::UnitY()};  ///< unit, camera frame
  std::array<float, 2> strength = {0.6F, 0.2F};
};

}  // namespace bodyloom
