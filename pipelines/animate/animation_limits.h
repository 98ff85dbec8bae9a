// SPDX-License-Identifier: Apache-2.0
/// Limits and options common to all videos of a person who is animated by a track.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

inline constexpr double kFpsWithoutTimes = 30;  ///< frame rate of a track without times
inline constexpr int kLongestImageSide = 8192;

// Freezes: one frame shown repeatedly, as given by `--freeze FRAME:COUNT`.

struct Freeze {
  int frame = 0;
  int count = 0;  ///< times that the frame is shown again
};

/// Parses a freeze of a clip of `num_frames` frames. Throws RequestError.
Freeze ReadFreeze(const std::string& text, int num_frames);

// View angles: rotation of each frame's view about the person's vertical axis, as given by `--view-yaw`.

/// Angle of each frame: "30" turns every frame by 30°; "0:360" goes from 0 up to frame `first` to 360 from frame `last`
/// on, linearly in between; "" gives no angles. Throws RequestError.
std::vector<double> ViewAngles(const std::string& text, int num_frames, int first, int last);

}  // namespace bodyloom
