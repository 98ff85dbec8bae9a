// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/chain/frozen_frames.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bodyloom {

namespace {

/// Frozen frames are released when the predicted decrease of the others falls below so many times theirs …
constexpr double kLevel = 2;
/// … unless that was less than this part of the tolerance.
constexpr double kNegligible = 0.1;
/// Frames beside a moving one that move too: smoothness hands its step on.
constexpr Eigen::Index kReach = 4;
/// So few frames between moving ones are not worth freezing (and one alone would not be allowed: chain_factor.h).
constexpr Eigen::Index kShortest = 4;
/// A chain of which less than this part would be frozen is not divided.
constexpr double kWorthwhile = 0.3;

}  // namespace

void FrozenFrames::Clear() {
  frames_.clear();
  frozen_decrease_ = 0;
  moving_share_ = 1;
}

void FrozenFrames::Tried(const Eigen::VectorXd& gradient, const Eigen::VectorXd& damping, const Eigen::VectorXd& step,
                         int n) {
  if (share_ <= 0) return;
  predicted_decreases_.resize(step.size() / n);
  for (Eigen::Index t = 0; t < predicted_decreases_.size(); ++t) {
    if (IsFrozen(t)) continue;
    const auto d = step.segment(t * n, n);
    predicted_decreases_[t] = 0.5 * (std::abs(gradient.segment(t * n, n).dot(d)) +
                                     (damping.segment(t * n, n).array() * d.array().square()).sum());
  }
}

void FrozenFrames::Taken(double predicted_decrease, double tolerance) {
  if (share_ <= 0) return;
  if (frozen_decrease_ > kNegligible * tolerance && predicted_decrease < kLevel * frozen_decrease_) {
    Clear();
  } else {
    Plan(share_ * predicted_decrease);
  }
}

void FrozenFrames::Plan(double more) {
  const Eigen::Index T = predicted_decreases_.size();
  std::vector<std::pair<double, Eigen::Index>> moving;
  for (Eigen::Index t = 0; t < T; ++t) {
    if (!IsFrozen(t)) moving.emplace_back(predicted_decreases_[t], t);
  }
  std::sort(moving.begin(), moving.end());
  std::vector<char> next(T, 1);
  for (const auto& [decrease, t] : moving) {
    more -= decrease;
    if (more >= 0) continue;
    for (Eigen::Index u = std::max<Eigen::Index>(0, t - kReach); u <= std::min(T - 1, t + kReach); ++u) {
      if (!IsFrozen(u)) next[u] = 0;
    }
  }
  for (Eigen::Index begin = 0, t = 0; t <= T; ++t) {
    if (t < T && next[t] != 0) continue;
    if (t - begin < kShortest) std::fill(next.begin() + begin, next.begin() + t, 0);
    begin = t + 1;
  }
  const auto count = static_cast<double>(std::count(next.begin(), next.end(), 1));
  if (count < kWorthwhile * static_cast<double>(T)) return;
  frames_ = std::move(next);
  moving_share_ = 1 - count / static_cast<double>(T);
  frozen_decrease_ = 0;
  for (Eigen::Index t = 0; t < T; ++t) frozen_decrease_ += IsFrozen(t) ? predicted_decreases_[t] : 0;
}

}  // namespace bodyloom
