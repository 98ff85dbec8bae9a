// SPDX-License-Identifier: Apache-2.0
/// Time that stands still while the camera goes on: bullet time.
#pragma once

#include <span>
#include <vector>

#include "bodyloom/geometry/track.h"

namespace bodyloom {

/// Which frame of `num_frames` is shown when: each in turn, and `frame` `count` times more. Throws
/// std::invalid_argument for a frame that is not there or a negative count.
std::vector<int> FrozenAt(int num_frames, int frame, int count);

/// The track's frames in that order, `1 / fps` apart with the track's mean rate, from its first timestamp on (a track
/// of one frame: 30 a second). Throws std::invalid_argument for frames that it has not.
Track FramesInOrder(const Track& track, std::span<const int> frames);

}  // namespace bodyloom
