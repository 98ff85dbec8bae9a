// SPDX-License-Identifier: Apache-2.0
/// Relocates invisible Gaussians to where the image is wrong. Their number, and hence the rendering time, stays.
///
/// A Gaussian with opacity below `dead_opacity` becomes a copy of another, sampled with probability proportional to
/// `pull`, at a position sampled from that one's distribution. Original and copy get the opacity 1 − sqrt(1 − o), so
/// that together they have the former opacity, and 0.8 times the size.
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

/// Returns the relocated rows, ascending; none without pull (all 0, or not finite). `pull`: by row; negative values and
/// those not finite count as 0. Deterministic. Throws std::invalid_argument unless there is one pull per row.
std::vector<int> RelocateGaussians(std::span<const float> pull, const RelocateOptions& options, GaussianBody* body);

}  // namespace bodyloom
