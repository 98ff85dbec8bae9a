// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/clothes_reach.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace bodyloom {
namespace {

/// Of every pixel the largest of the distances along x and y to the nearest pixel of the body.
std::vector<int> DistanceToBody(const MotionFrame& frame) {
  const int w = frame.width, h = frame.height;
  const int far = w + h;
  std::vector<int> distance(frame.body.size());
  for (size_t i = 0; i < distance.size(); ++i) distance[i] = frame.body[i] > 0 ? 0 : far;
  // Two sweeps are exact for this distance: a shortest path of king's moves need not turn back.
  const auto relax = [&](int x, int y, int dx, int dy) {
    const int from_x = x + dx, from_y = y + dy;
    if (from_x < 0 || from_x >= w || from_y < 0 || from_y >= h) return;
    int& here = distance[size_t(y) * w + x];
    here = std::min(here, distance[size_t(from_y) * w + from_x] + 1);
  };
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      for (const int dx : {-1, 0, 1}) relax(x, y, dx, -1);
      relax(x, y, -1, 0);
    }
  }
  for (int y = h - 1; y >= 0; --y) {
    for (int x = w - 1; x >= 0; --x) {
      for (const int dx : {-1, 0, 1}) relax(x, y, dx, 1);
      relax(x, y, 1, 0);
    }
  }
  return distance;
}

}  // namespace

int ClothesReach(std::span<const MotionFrame> frames, double left_out) {
  std::vector<int> distances;
  for (const MotionFrame& frame : frames) {
    const bool has_body = std::any_of(frame.body.begin(), frame.body.end(), [](float b) { return b > 0; });
    if (!has_body || frame.labels.size() != frame.body.size()) continue;
    const std::vector<int> to_body = DistanceToBody(frame);
    for (size_t i = 0; i < to_body.size(); ++i) {
      if (frame.labels[i] != 0) distances.push_back(to_body[i]);
    }
  }
  if (distances.empty()) return 0;
  const auto kept = static_cast<size_t>((1 - left_out) * static_cast<double>(distances.size() - 1));
  std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(kept), distances.end());
  return distances[kept];
}

}  // namespace bodyloom
