// SPDX-License-Identifier: Apache-2.0
/// What Gaussians cost by being there: without it, those that no picture needs would stay.
///   cost = (by_opacity Σ_i o_i + by_scale Σ_i Σ_k e^(s_ik)) / N,   scales in metres
/// Source: Kheradmand et al., "3D Gaussian Splatting as Markov Chain Monte Carlo", NeurIPS 2024, section 4.3.
#pragma once

#include "bodyloom/render/avatar/gaussian_body.h"

namespace bodyloom {

struct GaussianCost {
  float by_opacity = 1e-2F, by_scale = 1e-2F;
};

/// Adds the derivatives to those of a loss (columns of GaussianBody::parameters); returns the cost. Throws
/// std::invalid_argument for a table of another size.
double AddGaussianCost(const GaussianBody& body, const GaussianCost& cost, FloatColumns* gradient);

}  // namespace bodyloom
