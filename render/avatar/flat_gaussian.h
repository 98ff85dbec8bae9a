// SPDX-License-Identifier: Apache-2.0
/// A Gaussian that lies flat on a surface.
#pragma once

#include <Eigen/Core>

#include "bodyloom/render/avatar/gaussian_body.h"

namespace bodyloom {

struct FlatGaussian {
  Eigen::Vector3d place, normal;  ///< rest space; the normal of unit length
  double sigma_m = 0.01;          ///< along the surface; at least 10 µm
  float flatness = 1;             ///< σ across it, of σ along it
  float opacity_logit = 0, albedo = 0;
};

/// Sets place, turn, scales, opacity, albedo and normal of a row.
void SetFlatGaussian(const FlatGaussian& gaussian, int row, GaussianBody* body);

}  // namespace bodyloom
