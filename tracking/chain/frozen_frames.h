// SPDX-License-Identifier: Apache-2.0
/// Frozen frames of a chain: which frames stay where they are for a while. After a few steps most frames have converged
/// and a few move on along valleys of their own; steps of those few cost a few frames' work instead of the whole
/// clip's.
///
/// A frame's predicted decrease is its share in the quadratic model's decrease of the last step that it took part in,
///   ½ |g_tᵀδ_t| + ½ δ_tᵀΛ_tδ_t.
/// The frames with the least predicted decrease are frozen, together at most `share` of the step's decrease at a time.
/// All are released when the predicted decrease of the others falls below twice what the frozen ones had left; or,
/// where the frozen ones had less than a tenth of the descent's tolerance left, when the others have converged. Which
/// frames are frozen is decided by predicted decreases alone, so the path does not depend on the number of threads.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace bodyloom {

class FrozenFrames {
 public:
  /// 0: none is ever frozen.
  explicit FrozenFrames(double share) : share_(share) {}

  [[nodiscard]] bool any() const { return !frames_.empty(); }
  /// T, or empty: none.
  [[nodiscard]] const std::vector<char>& frames() const { return frames_; }
  /// Part of the frames that moves.
  [[nodiscard]] double moving_share() const { return moving_share_; }

  /// A step of frames of n values each (T·n; zero where they are frozen) that is about to be tried.
  void Tried(const Eigen::VectorXd& gradient, const Eigen::VectorXd& damping, const Eigen::VectorXd& step, int n);
  /// That step was taken, with this predicted decrease. More frames may be frozen now, or all are released: `tolerance`
  /// is the change of the cost at which the descent ends.
  void Taken(double predicted_decrease, double tolerance);
  /// Releases all.
  void Clear();

 private:
  void Plan(double more);
  [[nodiscard]] bool IsFrozen(Eigen::Index t) const { return any() && frames_[t] != 0; }

  double share_, frozen_decrease_ = 0, moving_share_ = 1;
  std::vector<char> frames_;
  Eigen::VectorXd predicted_decreases_;
};

}  // namespace bodyloom
