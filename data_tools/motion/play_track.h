// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bodyloom/geometry/track.h"

namespace bodyloom {

/// The track played `speed` times as fast (0.5: twice as long), at `fps` frames a second (0: the rate that it had):
/// frame t shows what the track shows at its time t0 + speed · t/fps (ResampleTrack,
/// data_tools/motion/resample_track.h, which says what is interpolated and what is not carried along). Throws
/// std::invalid_argument for a speed outside [0.05, 20], and unless every frame has a result and the clock is regular
/// (FrameRate, data_tools/motion/motion_tools.h).
Track PlayedAtSpeed(const Track& track, double speed, double fps = 0);

}  // namespace bodyloom
