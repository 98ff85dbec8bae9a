// SPDX-License-Identifier: Apache-2.0
/// Starts a shot of a live tracker: finds starting poses, and solves the shot's first frames jointly.
#pragma once

#include <cstdint>
#include <vector>

#include "tracking/live/live_window.h"

namespace bodyloom {

/// Starting states of the last `count` frames; empty if their observations do not suffice.
std::vector<FrameState> FindLiveStates(const LiveSetup& setup, int count, LiveWindow* window);

/// Begins a shot with the open frames, from the first that was seen on. Returns false if their observations do not
/// suffice.
bool StartShot(const LiveSetup& setup, LiveWindow* window);

/// Solves the shot's frames in the window again: first near their start, then free. With `count` > 0 the last `count`
/// of them get new starting states first, where these can be found.
void RestartShot(const LiveSetup& setup, int count, LiveWindow* window);

/// Updates the shape prior of a live tracker from the bone lengths seen in the shot so far.
class LiveShape {
 public:
  /// After 60, 120, 240, … frames of the clip, sets the mean of the shape prior to the shape that fits the bones'
  /// ratios in the shot's sample.
  void Refine(const LiveSetup& setup, LiveWindow* window);

 private:
  static constexpr int kFirstFrames = 60;
  int64_t next_frames_ = kFirstFrames;
};

}  // namespace bodyloom
