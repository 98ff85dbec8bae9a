// SPDX-License-Identifier: Apache-2.0
/// What Gaussians cost by being there: without it, those that no picture needs would stay.
///   cost = (Σ_i (by_opacity + by_distance (1 − φ_i)) o_i + by_scale Σ_i Σ_k e^(s_ik)) / N,   scales in metres
/// with φ_i the anchor's factor, 1 on the skin and 0 from 6 cm off it. Cloth has a place of its own and is opaque: its
/// opacity costs nothing. The second term takes away what a clip in which the
/// arms are never raised leaves between arm and trunk: in other poses it would float about as shreds.
/// Source: Kheradmand et al., "3D Gaussian Splatting as Markov Chain Monte Carlo", NeurIPS 2024, section 4.3.
#pragma once

#include "bodyloom/render/avatar/gaussian_body.h"

namespace bodyloom {

struct GaussianCost {
  float by_opacity = 1e-2F, by_scale = 1e-2F, by_distance = 0.3F;
};

/// Adds the derivatives to those of a loss (columns of GaussianBody::parameters); returns the cost. Throws
/// std::invalid_argument for a table of another size.
double AddGaussianCost(const GaussianBody& body, const GaussianCost& cost, FloatColumns* gradient);

}  // namespace bodyloom
