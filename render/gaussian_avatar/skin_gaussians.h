// SPDX-License-Identifier: Apache-2.0
/// Initialises a person of Gaussians: one per texel of the body's surface, flat along it (SkinGaussians); others,
/// evenly spaced, on a simulated garment (ClothGaussians).
#pragma once

#include <Eigen/Core>
#include <string>

#include "geometry/body/body_model.h"
#include "geometry/cloth/cloth_nodes.h"
#include "geometry/uv_maps/uv_texels.h"
#include "render/gaussian_avatar/gaussian_body.h"

namespace bodyloom {

struct SkinGaussiansOptions {
  float texels_sigma = 0.6F;  ///< 0.01 to 100: standard deviation along the surface, in texels' widths there
  float flatness = 0.37F;     ///< 0.001 to 1: σ along the normal relative to that along the surface
  float opacity_logit = 2;    ///< −20 to 20: 0.88
  float albedo = 0.4F;        ///< 0 to 1: grey
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Creates one Gaussian per texel of `texels` (without gutters), in their order: at the texel's point on the body's
/// shape in T-pose, the third axis along the face's normal, with the six largest skinning weights (padded by joint 0 at
/// 1e-6), anchored with corrective factor 1. A texel's width is the square root of its area on the surface. The light
/// is even: shading 1 everywhere. Throws std::invalid_argument when options are not valid, betas are longer than the
/// body's, or the table is not of a body with UV.
GaussianBody SkinGaussians(const BodyModel& model, const Eigen::VectorXd& betas, const UvTexelTable& texels,
                           const SkinGaussiansOptions& options = {});

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
