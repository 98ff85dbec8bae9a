// SPDX-License-Identifier: Apache-2.0
/// A freeze, time that stands still at a frame, as `--freeze FRAME:COUNT` gives it.
#pragma once

#include <string>

namespace bodyloom {

struct Freeze {
  int frame = 0;
  int count = 0;  ///< times that the frame is shown again
};

/// Of a clip of `num_frames`. Throws RequestError.
Freeze ReadFreeze(const std::string& text, int num_frames);

}  // namespace bodyloom
