// SPDX-License-Identifier: Apache-2.0
/// A smooth prior over time that does not grow stronger with the number of frames: a stationary Gaussian process with
/// the Matérn 3/2 covariance
///   k(d) = σ² (1 + √3 d / l) exp(−√3 d / l),   d = |t − t'|
/// Each frame is conditioned on the two before it, so that every three neighbours have the process's own distribution
/// whatever their distances in time; where nothing is seen, values return to zero with the standard deviation σ.
/// Source: Rasmussen and Williams, Gaussian Processes for Machine Learning, 2006, equation 4.17; Vecchia, Estimation
/// and Model Identification for Continuous Spatial Processes, 1988.
#pragma once

#include <ceres/problem.h>

#include <vector>

namespace bodyloom {

/// x_t = last · x_{t−1} + before · x_{t−2} + sigma · ε, ε of standard deviation 1, for a process of σ = 1.
struct SteadyStep {
  double last = 0, before = 0, sigma = 1;
};

/// After frames `to_last_s` and `to_before_s` seconds ago; infinity: there is none.
SteadyStep SteadyStepOf(double to_last_s, double to_before_s, double length_s);

struct SteadyPrior {
  double sigma = 1, length_s = 1;
};

/// Adds the prior on every component of the blocks, all of `size`, one a frame. `cut_before[t]`: frame t continues
/// none. Residuals of frame t read the blocks of t and of up to two frames before it.
void AddSteadyPrior(const SteadyPrior& prior, const std::vector<double*>& blocks, int size,
                    const std::vector<double>& times_s, const std::vector<char>& cut_before, ceres::Problem* problem);

/// A detector's errors last for some frames: as many independent ones an observation of frame t counts as,
///   (1 − r) / (1 + r),   r = exp(−Δt / last_s),
/// with Δt to the nearer neighbour that the frame continues or that continues it.
double IndependentShare(size_t t, const std::vector<double>& times_s, const std::vector<char>& cut_before,
                        double last_s);

}  // namespace bodyloom
