// SPDX-License-Identifier: Apache-2.0
/// The start of a shot of a live tracker: starting poses, and solves of all its first frames together.
#pragma once

#include <cstdint>
#include <vector>

#include "tracking/live/live_window.h"

namespace bodyloom {

/// Starting states of the last `count` frames; empty when they do not show enough.
std::vector<FrameState> FindLiveStates(const LiveSetup& setup, int count, LiveWindow* window);

/// Begins a shot with the open frames, from the first that was seen on. False when they do not show enough.
bool StartShot(const LiveSetup& setup, LiveWindow* window);

/// Solves the shot's frames in the window again: first near their start, then free. With `count` > 0 the last `count`
/// of them get new starting states first, where these can be found.
void RestartShot(const LiveSetup& setup, int count, LiveWindow* window);

// The shape that a live tracker expects: now and then read off the bones of what it has seen of the shot.

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
