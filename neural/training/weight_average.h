// SPDX-License-Identifier: Apache-2.0
/// The average of a network's weights over the last part of a run. Internal: includes LibTorch.
///
///   w̄_n = w̄_{n−1} + (w_n − w̄_{n−1}) (γ + 1) / (n + γ),   γ = 1 / share − 2,   n = 1, 2, … steps
/// The steps so far, each weighted by some t^γ: their mean age is `share` of the steps, however long the run. The last
/// steps of Adam wander around an optimum; their mean lies nearer to it, whatever the learning rate. Source:
/// polynomial-decay averaging, Shamir and Zhang, "Stochastic gradient descent for non-smooth optimization", ICML 2013.
#pragma once

#include <torch/torch.h>

#include <cstdint>

namespace bodyloom {

/// Moves `average` towards `learner`, which has the same parameters and buffers; buffers are copied. n counts from 1,
/// where the average is the learner. Throws std::invalid_argument for networks that differ, for n below 1 and for a
/// share outside (0, 0.5].
void AverageWeights(const torch::nn::Module& learner, int64_t n, double share, torch::nn::Module* average);

}  // namespace bodyloom
