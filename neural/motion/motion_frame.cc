// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/motion_frame.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "render/garment/clothes_offset_map.h"

namespace bodyloom {
namespace {

/// Chebyshev distance of every pixel to the body.
std::vector<int> DistanceToBody(const MotionFrame& frame) {
  const int w = frame.width, h = frame.height;
  const int far = w + h;
  std::vector<int> distance(frame.body.size());
  for (size_t i = 0; i < distance.size(); ++i) distance[i] = frame.body[i] > 0 ? 0 : far;
  SweepNeighbours(w, h, /*rows_back=*/false,
                  [&](size_t here, size_t there) { distance[here] = std::min(distance[here], distance[there] + 1); });
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
