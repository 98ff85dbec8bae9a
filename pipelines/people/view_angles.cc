// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/people/view_angles.h"

#include <algorithm>
#include <cstdio>

#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {

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
