// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/motion_level.h"

#include <algorithm>
#include <cmath>

#include "bodyloom/geometry/rotation.h"
#include "bodyloom/tracking/residuals/acceleration_cost.h"

namespace bodyloom {

std::vector<double> TipAccelerationRms(const SequenceProblem& problem, int shot) {
  const std::vector<int> shots = ShotOfFrames(problem.cut_before);
  std::vector<double> rms = JointLevers(*problem.layout.model);
  std::vector<char> active(rms.size(), 0);
  for (const int j : problem.layout.active_joints) active[j] = 1;
  const auto [begin, end] = std::equal_range(shots.begin(), shots.end(), shot);
  const auto first = static_cast<size_t>(begin - shots.begin()), last = static_cast<size_t>(end - shots.begin());
  for (size_t j = 0; j < rms.size(); ++j) {
    double squares = 0;
    int64_t count = 0;
    for (size_t t = first + 2; active[j] != 0 && t < last; ++t) {
      const AccelerationFactors f = AccelerationFactors::Of(problem.timestamps[t - 1] - problem.timestamps[t - 2],
                                                            problem.timestamps[t] - problem.timestamps[t - 1]);
      const Eigen::Matrix3d &a = problem.states[t - 2].rotations[j], &b = problem.states[t - 1].rotations[j],
                            &c = problem.states[t].rotations[j];
      const double squared = (rms[j] * (f.later * AxisAngleFromRotation(b.transpose() * c) -
                                        f.earlier * AxisAngleFromRotation(a.transpose() * b)))
                                 .squaredNorm();
      if (!std::isfinite(squared)) continue;
      squares += squared;
      ++count;
    }
    rms[j] = count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0;
  }
  return rms;
}

std::vector<Smoothness> FitSmoothness(const SequenceProblem& problem, const Smoothness& before) {
  std::vector<Smoothness> fitted(1 + ShotOfFrames(problem.cut_before).back(), before);
  for (size_t shot = 0; shot < fitted.size(); ++shot) {
    const std::vector<double> rms = TipAccelerationRms(problem, static_cast<int>(shot));
    double squares = 0;
    for (const double r : rms) squares += r * r;
    if (!(squares > 0)) continue;
    const double all = std::sqrt(squares / static_cast<double>(problem.layout.active_joints.size()));
    const double sigma = std::clamp(kSigmaOfRms * all, kLeastSigma, kMostSigma);
    Smoothness& smooth = fitted[shot];
    smooth.root_acceleration *= sigma / before.tip_acceleration;
    smooth.weak_scale_acceleration *= sigma / before.tip_acceleration;
    smooth.tip_acceleration = sigma;
    smooth.of_joint.resize(rms.size());
    for (size_t j = 0; j < rms.size(); ++j) {
      smooth.of_joint[j] = std::clamp(kSigmaOfRms * rms[j], kLeastOfJoint, kMostOfJoint);
    }
  }
  return fitted;
}

}  // namespace bodyloom
