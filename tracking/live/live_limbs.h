// SPDX-License-Identifier: Apache-2.0
/// Limbs on the wrong side of a live tracker's pose: the lifter's poses are tried against it.
#pragma once

#include "bodyloom/tracking/body_points.h"
#include "bodyloom/tracking/live/live_lifter.h"
#include "bodyloom/tracking/live/live_window.h"

namespace bodyloom {

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
