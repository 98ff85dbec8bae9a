// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/camera_knowledge.h"

#include <cmath>

namespace bodyloom {

FocalFit JoinFocalFits(std::span<const FocalFit> fits, const FocalPrior& prior) {
  constexpr double kShared = kFocalFitLogSigma * kFocalFitLogSigma;
  const double prior_information = 1 / (prior.log_sigma * prior.log_sigma);
  double weights = 0, sum = 0, variance = 0;
  for (const FocalFit& fit : fits) {
    if (!(fit.log_sigma > 0) || !std::isfinite(fit.log_px)) continue;
    const double posterior = 1 / (fit.log_sigma * fit.log_sigma);
    const double measured = posterior - prior_information;
    // A posterior is never wider than its prior but by rounding.
    if (!(measured > 1e-9 * prior_information)) continue;
    const double answer = (posterior * fit.log_px - prior_information * prior.log_mean) / measured;
    const double weight = 1 / (1 / measured + kShared);
    weights += weight;
    sum += weight * answer;
    variance += weight * weight / measured;
  }
  if (!(weights > 0)) return {prior.log_mean, prior.log_sigma};
  const double measured = 1 / (kShared + variance / (weights * weights));
  const double information = prior_information + measured;
  return {(prior_information * prior.log_mean + measured * sum / weights) / information, 1 / std::sqrt(information)};
}

}  // namespace bodyloom
