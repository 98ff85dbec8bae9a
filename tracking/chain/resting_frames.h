// SPDX-License-Identifier: Apache-2.0
/// Which frames of a chain may stay where they are for a while. After a few steps most frames have arrived and a few
/// creep along valleys of their own; steps of those few cost a few frames' work instead of the whole clip's.
///
/// A frame's promise is the size of its share in the model's decrease of the last step that it took part in,
///   ½ |g_tᵀδ_t| + ½ δ_tᵀΛ_tδ_t.
/// The frames that promise least rest, together at most `share` of the step's decrease at a time. All are to move again
/// when the others promise less than twice what the resting ones did; or, where the resting ones promised less than a
/// tenth of the descent's tolerance, when the others have settled. What rests is decided by promises alone, so the path
/// does not depend on the number of threads.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace bodyloom {

class RestingFrames {
 public:
  /// 0: none ever rests.
  explicit RestingFrames(double share) : share_(share) {}

  [[nodiscard]] bool any() const { return !frames_.empty(); }
  /// T, or empty: none.
  [[nodiscard]] const std::vector<char>& frames() const { return frames_; }
  /// Part of the frames that moves.
  [[nodiscard]] double moving_share() const { return moving_share_; }

  /// A step of frames of n values each (T·n; zero where they rest) that is about to be tried.
  void Tried(const Eigen::VectorXd& gradient, const Eigen::VectorXd& damping, const Eigen::VectorXd& step, int n);
  /// That step was taken; the model had promised this decrease of it. More frames may rest now, or all are to move:
  /// `tolerance` is the change of the cost at which the descent ends.
  void Taken(double promised, double tolerance);
  /// All move.
  void Clear();

 private:
  void Plan(double more);
  [[nodiscard]] bool Rests(Eigen::Index t) const { return any() && frames_[t] != 0; }

  double share_, resting_promise_ = 0, moving_share_ = 1;
  std::vector<char> frames_;
  Eigen::VectorXd promises_;
};

}  // namespace bodyloom
