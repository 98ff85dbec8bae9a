// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/motion/play_track.h"

#include "bodyloom/data_tools/motion/motion_tools.h"
#include "bodyloom/data_tools/motion/resample_track.h"
#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

Track PlayedAtSpeed(const Track& track, double speed, double fps) {
  BODYLOOM_CHECK(speed >= 0.05 && speed <= 20, "speed ", speed, ", expected 0.05 to 20");
  for (int t = 0; t < track.num_frames(); ++t) {
    BODYLOOM_CHECK(track.HasResult(t), "frame ", t, " has no result: another speed needs a track without gaps");
  }
  const double own_fps = FrameRate(track.motion);
  BODYLOOM_CHECK(own_fps > 0, "another speed needs two frames or more with equal time between them");
  Track stretched = track;
  const double begin = track.motion.timestamps.front();
  for (double& time : stretched.motion.timestamps) time = begin + (time - begin) / speed;
  return ResampleTrack(stretched, fps > 0 ? fps : own_fps);
}

}  // namespace bodyloom
