// SPDX-License-Identifier: Apache-2.0
/// Gaussians on a simulated garment to begin with.
#pragma once

#include <string>

#include "geometry/body/body_model.h"
#include "geometry/cloth/cloth_nodes.h"
#include "render/gaussian_avatar/gaussian_body.h"

namespace bodyloom {

struct ClothGaussiansOptions {
  float spacing_m = 0.012F;  ///< 0.003 to 0.2: about, from one to the next
  int count = 12000;         ///< 1 or more: at most so many
  float sigma = 0.9F;        ///< 0.01 to 100: σ along the cloth, of how far apart they come to lie
  float flatness = 0.37F;    ///< 0.001 to 1: σ across it, of σ along it
  float opacity_logit = 3;   ///< −20 to 20
  float albedo = 0.4F;       ///< 0 to 1
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Spread evenly over the garment's faces as sewn, flat along them, normals outwards. Each hangs on the nodes near it
/// (ClothNodes::Near), named after the body's joints, and is anchored at the body's vertex nearest to it in rest space,
/// whose pose corrective it does not follow. The light stays zero: the answer is to be appended to SkinGaussians().
/// Throws std::invalid_argument when options are not valid.
GaussianBody ClothGaussians(const BodyModel& model, const Eigen::VectorXd& betas, const LooseGarment& garment,
                            const ClothNodes& nodes, const ClothGaussiansOptions& options = {});

}  // namespace bodyloom
