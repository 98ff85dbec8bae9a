// SPDX-License-Identifier: Apache-2.0
/// What holds of every video of a person who is moved by a track.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

inline constexpr double kFpsWithoutTimes = 30;  ///< frame rate of a track without times
inline constexpr int kLongestPictureSide = 8192;

// A freeze, time that stands still at a frame, as `--freeze FRAME:COUNT` gives it.

struct Freeze {
  int frame = 0;
  int count = 0;  ///< times that the frame is shown again
};

/// Of a clip of `num_frames`. Throws RequestError.
Freeze ReadFreeze(const std::string& text, int num_frames);

// View angles: how far every frame's view is turned about the person's vertical, as `--view-yaw` gives it.

/// "30": every frame turned by 30°; "0:360": 0 up to frame `first`, 360 from frame `last` on, evenly in between; "":
/// none. Throws RequestError.
std::vector<double> ViewAngles(const std::string& text, int num_frames, int first, int last);

}  // namespace bodyloom
