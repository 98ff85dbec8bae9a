// SPDX-License-Identifier: Apache-2.0
/// Runs the lifter in a live tracker, and corrects limbs on the wrong side by its poses.
#pragma once

#include <vector>

#include "tracking/live/live_window.h"
#include "tracking/problem/body_points.h"

namespace bodyloom {

/// The lifter's predictions for the window's last frames.
struct LiveReading {
  std::vector<LiftedFrame> frames;  ///< one frame every `stride`, the last of them the window's last; empty: not run
  int stride = 1;
  double metres = 0;  ///< of its unit
};

/// Runs the lifter at its own rate on the past frames; the frames still open are predicted again with later context.
class LiveLifter {
 public:
  /// The next frame counts as the first of a shot.
  void Restart() { since_last_ = 0; }
  /// Runs the lifter if it is due, and writes its predictions to the window's frames of the current shot.
  LiveReading Ask(const LiveSetup& setup, LiveWindow* window);

 private:
  int since_last_ = 0;  ///< frames
};

class LiveLimbs {
 public:
  /// Tries the lifter's poses in short solves when limbs of the window's last frames are far from its predictions, once
  /// for these limbs only and once for the whole body, and keeps the solution of lower cost. Pauses for some readings
  /// after a try.
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
