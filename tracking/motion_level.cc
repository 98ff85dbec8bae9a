// SPDX-License-Identifier: Apache-2.0
#include "tracking/motion_level.h"

#include <algorithm>
#include <cmath>

#include "geometry/rotation.h"
#include "tracking/residuals/acceleration_cost.h"

namespace bodyloom {

double TipAccelerationRms(const SequenceProblem& problem) {
  const std::vector<double> levers = JointLevers(*problem.layout.model);
  double squares = 0;
  int64_t count = 0;
  for (size_t t = 2; t < problem.states.size(); ++t) {
    if (problem.cut_before[t] || problem.cut_before[t - 1]) continue;
    const AccelerationFactors f = AccelerationFactors::Of(problem.timestamps[t - 1] - problem.timestamps[t - 2],
                                                          problem.timestamps[t] - problem.timestamps[t - 1]);
    for (const int j : problem.layout.active_joints) {
      const Eigen::Matrix3d &a = problem.states[t - 2].rotations[j], &b = problem.states[t - 1].rotations[j],
                            &c = problem.states[t].rotations[j];
      const double squared = (levers[j] * (f.later * AxisAngleFromRotation(b.transpose() * c) -
                                           f.earlier * AxisAngleFromRotation(a.transpose() * b)))
                                 .squaredNorm();
      if (!std::isfinite(squared)) continue;
      squares += squared;
      ++count;
    }
  }
  return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0;
}

Smoothness FitSmoothness(const SequenceProblem& problem, const Smoothness& smoothness) {
  if (std::any_of(problem.cut_before.begin(), problem.cut_before.end(), [](char cut) { return cut != 0; })) {
    return smoothness;
  }
  const double rms = TipAccelerationRms(problem);
  if (!(rms > 0)) return smoothness;
  const double sigma = std::clamp(kSigmaOfRms * rms, kLeastSigma, kMostSigma);
  Smoothness fitted = smoothness;
  fitted.root_acceleration *= sigma / smoothness.tip_acceleration;
  fitted.weak_scale_acceleration *= sigma / smoothness.tip_acceleration;
  fitted.tip_acceleration = sigma;
  return fitted;
}

}  // namespace bodyloom
