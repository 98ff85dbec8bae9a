// SPDX-License-Identifier: Apache-2.0
/// View angles: how far every frame's view is turned about the person's vertical, as `--view-yaw` gives it.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

/// "30": every frame turned by 30°; "0:360": 0 up to frame `first`, 360 from frame `last` on, evenly in between; "":
/// none. Throws RequestError.
std::vector<double> ViewAngles(const std::string& text, int num_frames, int first, int last);

}  // namespace bodyloom
