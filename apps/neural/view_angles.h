// SPDX-License-Identifier: Apache-2.0
/// `--view-yaw`: how far every frame's view is turned.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

/// "30": every frame turned by 30°; "0:360": from 0 to 360 over the clip; "": none. Throws UsageError.
std::vector<double> ViewAngles(const std::string& text, int num_frames);

}  // namespace bodyloom
