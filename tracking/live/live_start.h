// SPDX-License-Identifier: Apache-2.0
/// The start of a shot of a live tracker: starting poses, and solves of all its first frames together.
#pragma once

#include <vector>

#include "bodyloom/tracking/live/live_window.h"

namespace bodyloom {

/// Starting states of the last `count` frames; empty when they do not show enough.
std::vector<FrameState> FindLiveStates(const LiveSetup& setup, int count, LiveWindow* window);

/// Begins a shot with the open frames, from the first that was seen on. False when they do not show enough.
bool StartShot(const LiveSetup& setup, LiveWindow* window);

/// Solves the shot's frames in the window again: first near their start, then free. With `count` > 0 the last `count`
/// of them get new starting states first, where these can be found.
void RestartShot(const LiveSetup& setup, int count, LiveWindow* window);

}  // namespace bodyloom
