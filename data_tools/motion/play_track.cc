// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/motion/play_track.h"

#include <algorithm>
#include <cmath>

#include "bodyloom/data_tools/motion/motion_tools.h"
#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

Track PlayedAtSpeed(const Track& track, double speed) {
  BODYLOOM_CHECK(speed >= 0.05 && speed <= 20, "speed ", speed, ", expected 0.05 to 20");
  for (int t = 0; t < track.num_frames(); ++t) {
    BODYLOOM_CHECK(track.HasResult(t), "frame ", t, " has no result: another speed needs a track without gaps");
  }
  const double fps = FrameRate(track.motion);
  BODYLOOM_CHECK(fps > 0, "another speed needs two frames or more with equal time between them");
  Track played;
  played.camera = track.camera;
  Motion stretched = track.motion;
  for (double& time : stretched.timestamps) {
    time = track.motion.timestamps.front() + (time - track.motion.timestamps.front()) / speed;
  }
  played.motion = ResampleMotion(stretched, fps);
  const int T = played.num_frames(), last = track.num_frames() - 1;
  played.weak_camera.resize(track.weak_camera.rows() > 0 ? T : 0, 3);
  for (int t = 0; t < T; ++t) {
    const double at = std::min<double>(speed * t, last);
    played.frame_status.push_back(track.frame_status.at(static_cast<size_t>(std::lround(at))));
    if (track.weak_camera.rows() == 0) continue;
    const int before = std::min(static_cast<int>(at), std::max(0, last - 1));
    const double s = at - before;
    played.weak_camera.row(t) =
        (1 - s) * track.weak_camera.row(before) + s * track.weak_camera.row(std::min(before + 1, last));
  }
  return played;
}

}  // namespace bodyloom
