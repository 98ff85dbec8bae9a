// SPDX-License-Identifier: Apache-2.0
#include "pipelines/animate/animation_limits.h"

#include <algorithm>
#include <cstdio>

#include "geometry/base/callbacks.h"
#include "geometry/base/check.h"

namespace bodyloom {

Freeze ReadFreeze(const std::string& text, int num_frames) {
  constexpr int kMaximum = 100000;
  Freeze freeze;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%d:%d%c", &freeze.frame, &freeze.count, &rest) != 2 || freeze.frame < 0 ||
      freeze.frame >= num_frames || freeze.count < 1 || freeze.count > kMaximum) {
    throw RequestError(Concatenate("--freeze ", text,
                                   ": expected FRAME:COUNT, such as 40:60; the clip has frames 0 to ", num_frames - 1,
                                   ", and COUNT is 1 to ", kMaximum));
  }
  return freeze;
}

std::vector<double> ViewAngles(const std::string& text, int num_frames, int first, int last) {
  if (text.empty()) return {};
  double from = 0, to = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf:%lf%c", &from, &to, &rest) != 2) {
    if (std::sscanf(text.c_str(), "%lf%c", &from, &rest) != 1) {
      throw RequestError("--view-yaw " + text + ": expected degrees, such as 30 or 0:360");
    }
    to = from;
  }
  std::vector<double> angles;
  angles.reserve(static_cast<size_t>(std::max(0, num_frames)));
  for (int t = 0; t < num_frames; ++t) {
    angles.push_back(from + (to - from) * std::clamp(t - first, 0, last - first) / std::max(1, last - first));
  }
  return angles;
}

}  // namespace bodyloom
