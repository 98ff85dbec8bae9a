// SPDX-License-Identifier: Apache-2.0
/// Initialises Gaussians on a simulated garment.
#pragma once

#include <string>

#include "geometry/body/body_model.h"
#include "geometry/cloth/cloth_nodes.h"
#include "render/gaussian_avatar/gaussian_body.h"

namespace bodyloom {

struct ClothGaussiansOptions {
  float spacing_m = 0.012F;  ///< 0.003 to 0.2: approximate distance between neighbours
  int count = 12000;         ///< at least 1: maximum number
  float sigma = 0.9F;        ///< 0.01 to 100: σ along the cloth relative to the actual spacing
  float flatness = 0.37F;    ///< 0.001 to 1: σ across the cloth relative to that along it
  float opacity_logit = 3;   ///< −20 to 20
  float albedo = 0.4F;       ///< 0 to 1
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Distributes Gaussians evenly over the garment's faces as sewn, flat along them, normals outwards. Each is skinned to
/// the nodes near it (ClothNodes::Near), numbered after the body's joints, and anchored, with corrective factor 0, at
/// the body's nearest vertex in rest space. The light stays zero: append the result to SkinGaussians(). Throws
/// std::invalid_argument when options are not valid.
GaussianBody ClothGaussians(const BodyModel& model, const Eigen::VectorXd& betas, const LooseGarment& garment,
                            const ClothNodes& nodes, const ClothGaussiansOptions& options = {});

}  // namespace bodyloom
