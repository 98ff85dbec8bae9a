// SPDX-License-Identifier: Apache-2.0
/// Limbs on the wrong side of a live tracker's pose: the lifter's poses are tried against it.
#pragma once

#include <vector>

#include "tracking/live/live_window.h"
#include "tracking/problem/body_points.h"

namespace bodyloom {

// The lifter in a live tracker: read at its own rate on what is past, and again when frames have come behind.

/// The lifter's predictions for the window's last frames.
struct LiveReading {
  std::vector<LiftedFrame> frames;  ///< one frame every `stride`, the last of them the window's last; empty: not run
  int stride = 1;
  double metres = 0;  ///< of its unit
};

class LiveLifter {
 public:
  /// The next frame counts as the first of a shot.
  void Restart() { since_last_ = 0; }
  /// Runs the lifter where its turn has come, and puts its predictions into the window's frames of the current shot.
  LiveReading Ask(const LiveSetup& setup, LiveWindow* window);

 private:
  int since_last_ = 0;  ///< frames
};

class LiveLimbs {
 public:
  /// Where limbs of the window's last frames are not where the lifter predicts them, tries its poses instead in a short
  /// solve, of these limbs alone and of the whole body, and keeps what costs less. Pauses for some readings after a
  /// try.
  void Try(const LiveSetup& setup, const LiveReading& reading, LiveWindow* window);

 private:
  /// Limbs (bit set) whose joints are far from the lifter's.
  unsigned LimbsOff(const LiveSetup& setup, const Eigen::VectorXd& betas, const FrameState& state,
                    const LiftedFrame& lifted, double metres);

  int until_next_ = 0;  ///< readings in which Try() does nothing
  Kinematics kinematics_;
  PointEvaluator points_;
};

}  // namespace bodyloom
