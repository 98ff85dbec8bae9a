// SPDX-License-Identifier: Apache-2.0
/// The average of a network's weights over the last steps of a run. Internal: includes LibTorch.
///
///   w̄_n = w̄_{n−1} + (w_n − w̄_{n−1}) / min(n, horizon),   n = 1, 2, … updates
/// The plain mean of the first `horizon` updates, then an exponential average that remembers some `horizon` steps. The
/// last steps of Adam wander around an optimum; their mean lies nearer to it, which a network that is fed its own
/// output shows first. Source: Polyak and Juditsky, "Acceleration of stochastic approximation by averaging", SIAM J.
/// Control and Optimization 30(4), 1992.
#pragma once

#include <torch/torch.h>

#include <cstdint>

namespace bodyloom {

/// Moves `average` towards `learner`, which has the same parameters and buffers; n counts from 1. Buffers, and with a
/// horizon of 1 the parameters too, are copied. Throws std::invalid_argument for networks that differ and for n or a
/// horizon below 1.
void AverageWeights(const torch::nn::Module& learner, int64_t n, double horizon, torch::nn::Module* average);

}  // namespace bodyloom
