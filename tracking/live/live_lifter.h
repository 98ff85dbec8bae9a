// SPDX-License-Identifier: Apache-2.0
/// The lifter in a live tracker: read at its own rate on what is past, and again when frames have come behind.
#pragma once

#include <vector>

#include "bodyloom/tracking/live/live_window.h"

namespace bodyloom {

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

}  // namespace bodyloom
