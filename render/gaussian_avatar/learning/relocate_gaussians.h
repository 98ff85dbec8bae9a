// SPDX-License-Identifier: Apache-2.0
/// Gaussians that nobody sees any more, moved to where the picture is wrong. Their number, and so the cost of a
/// picture, stays.
///
/// A Gaussian of opacity below `dead_opacity` becomes a copy of a living one, drawn with a chance proportional to
/// `pull`, at a place drawn from that one's own distribution. Original and copy then get the opacity 1 − sqrt(1 − o),
/// so that the two together cover what the one did, and 0.8 times the size.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/gaussian_avatar/gaussian_body.h"

namespace bodyloom {

struct RelocateOptions {
  float dead_opacity = 0.015F;
  uint64_t seed = 1;
};

/// Rows that were moved, in their order; without pull (all 0, or not finite) none. `pull`: by row, negative and
/// not finite ones count as 0. A function of the arguments alone. Throws std::invalid_argument for another number of
/// pulls than rows.
std::vector<int> RelocateGaussians(std::span<const float> pull, const RelocateOptions& options, GaussianBody* body);

}  // namespace bodyloom
