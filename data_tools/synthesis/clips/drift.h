// SPDX-License-Identifier: Apache-2.0
/// Random errors that change slowly.
#pragma once

#include <vector>

#include "bodyloom/geometry/base/hash_random.h"

namespace bodyloom {

/// One value a time (increasing, seconds), mean 0, variance 1, correlation exp(−Δt/τ): continuous but rough
/// (Ornstein–Uhlenbeck).
std::vector<double> RoughDrift(const std::vector<double>& times_s, double time_constant_s, HashRandom random);

/// One value a time, mean 0, variance about 1, differentiable: a sum of waves with random phases and frequencies spread
/// evenly below 1/(2π) · 2/time_constant_s.
std::vector<double> SmoothDrift(const std::vector<double>& times_s, double time_constant_s, HashRandom random);

}  // namespace bodyloom
