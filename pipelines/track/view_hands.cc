// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/view_hands.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bodyloom {

std::vector<int> NearestFrames(const std::vector<double>& own, const std::vector<double>& times, double fps) {
  std::vector<int> nearest;
  for (const double time : times) {
    auto at = std::lower_bound(own.begin(), own.end(), time);
    if (at == own.end() || (at != own.begin() && time - at[-1] < *at - time)) --at;
    nearest.push_back(std::abs(*at - time) > 0.51 / fps ? -1 : static_cast<int>(at - own.begin()));
  }
  return nearest;
}

HandsOfView HandsOfViewAt(const RigCamera& camera, const HandsAndFaceSequence& seen, std::vector<double> own,
                          bool first_clock, const std::vector<double>& times, double fps) {
  HandsOfView view;
  view.camera = camera;
  if (seen.empty()) return view;
  for (double& time : own) time = first_clock ? time : camera.FirstTimeAt(time);
  view.seen = seen;
  view.seen.timestamps = times;
  view.seen.frames.clear();
  for (const int frame : NearestFrames(own, times, fps)) {
    view.seen.frames.push_back(frame < 0 ? nullptr : seen.frames[size_t(frame)]);
  }
  return view;
}

}  // namespace bodyloom
