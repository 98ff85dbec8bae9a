// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/chain/resting_frames.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bodyloom {

namespace {

/// Resting frames move again when the others promise less than so many times what they did …
constexpr double kLevel = 2;
/// … unless that was less than this part of the tolerance.
constexpr double kNegligible = 0.1;
/// Frames beside a moving one that move too: smoothness hands its step on.
constexpr Eigen::Index kReach = 4;
/// So few frames between moving ones are not worth a rest (and one alone would not be allowed: chain_factor.h).
constexpr Eigen::Index kShortest = 4;
/// A chain of which less than this part would rest is not divided.
constexpr double kWorthwhile = 0.3;

}  // namespace

void RestingFrames::Clear() {
  frames_.clear();
  resting_promise_ = 0;
  moving_share_ = 1;
}

void RestingFrames::Tried(const Eigen::VectorXd& gradient, const Eigen::VectorXd& damping, const Eigen::VectorXd& step,
                          int n) {
  if (share_ <= 0) return;
  promises_.resize(step.size() / n);
  for (Eigen::Index t = 0; t < promises_.size(); ++t) {
    if (Rests(t)) continue;
    const auto d = step.segment(t * n, n);
    promises_[t] = 0.5 * (std::abs(gradient.segment(t * n, n).dot(d)) +
                          (damping.segment(t * n, n).array() * d.array().square()).sum());
  }
}

void RestingFrames::Taken(double promised, double tolerance) {
  if (share_ <= 0) return;
  if (resting_promise_ > kNegligible * tolerance && promised < kLevel * resting_promise_) {
    Clear();
  } else {
    Plan(share_ * promised);
  }
}

void RestingFrames::Plan(double more) {
  const Eigen::Index T = promises_.size();
  std::vector<std::pair<double, Eigen::Index>> moving;
  for (Eigen::Index t = 0; t < T; ++t) {
    if (!Rests(t)) moving.emplace_back(promises_[t], t);
  }
  std::sort(moving.begin(), moving.end());
  std::vector<char> next(T, 1);
  for (const auto& [promise, t] : moving) {
    more -= promise;
    if (more >= 0) continue;
    for (Eigen::Index u = std::max<Eigen::Index>(0, t - kReach); u <= std::min(T - 1, t + kReach); ++u) {
      if (!Rests(u)) next[u] = 0;
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
  resting_promise_ = 0;
  for (Eigen::Index t = 0; t < T; ++t) resting_promise_ += Rests(t) ? promises_[t] : 0;
}

}  // namespace bodyloom
