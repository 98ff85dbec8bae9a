// SPDX-License-Identifier: Apache-2.0
/// The shape that a live tracker expects: now and then read off the bones of what it has seen of the shot.
#pragma once

#include <cstdint>

#include "bodyloom/tracking/live/live_window.h"

namespace bodyloom {

class LiveShape {
 public:
  /// After 60, 120, 240, … frames of the clip the shape that fits the bones' ratios in the shot's sample becomes the
  /// mean of the shape prior.
  void Refine(const LiveSetup& setup, LiveWindow* window);

 private:
  static constexpr int kFirstFrames = 60;
  int64_t next_frames_ = kFirstFrames;
};

}  // namespace bodyloom
