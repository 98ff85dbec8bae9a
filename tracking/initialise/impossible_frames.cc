// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/impossible_frames.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tracking/initialise/swap_repair.h"

namespace bodyloom {
namespace {

constexpr double kLongest_s = 0.5;
constexpr double kJump = 0.15, kJumpSpeed = 4, kJumpSize = 1.8;  // body sizes, body sizes a second, ratio
constexpr double kContinues = 0.1, kContinuesSpeed = 1, kSameSize = 1.5;

struct Change {
  double distance = 0;  ///< median of the common landmarks, in sizes of the smaller body
  double size = 1;      ///< ratio of the larger body to the smaller
  bool known = false;
  [[nodiscard]] bool Continues(double seconds) const {
    return known && distance < kContinues + kContinuesSpeed * seconds && size < kSameSize;
  }
};

Change Between(const KeypointSequence& keypoints, const std::vector<double>& sizes, int a, int b) {
  std::vector<double> distances;
  for (int k = 0; k < keypoints.num_points(); ++k) {
    const Keypoint &p = keypoints.at(a, k), &q = keypoints.at(b, k);
    if (IsSeen(p) && IsSeen(q)) distances.push_back(std::hypot(p.x - q.x, p.y - q.y));
  }
  if (distances.size() < 4) return {};
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  const double small = std::min(sizes[a], sizes[b]);
  return {*middle / small, std::max(sizes[a], sizes[b]) / small, true};
}

}  // namespace

bool ContinuesFrame(const KeypointSequence& keypoints, int a, int b) {
  std::vector<double> sizes(keypoints.num_frames());
  for (int t : {a, b}) sizes[t] = SeenBodySize(keypoints, t);
  return sizes[a] > 0 && sizes[b] > 0 &&
         Between(keypoints, sizes, a, b).Continues(keypoints.timestamps[b] - keypoints.timestamps[a]);
}

int DropImpossibleFrames(KeypointSequence* keypoints) {
  const int T = keypoints->num_frames();
  std::vector<double> sizes(T);
  for (int t = 0; t < T; ++t) sizes[t] = SeenBodySize(*keypoints, t);
  int dropped = 0, good = -1;
  for (int t = 0; t < T; ++t) {
    if (sizes[t] <= 0) continue;
    const auto seconds = [&](int u) { return keypoints->timestamps[u] - keypoints->timestamps[good]; };
    if (good < 0 || seconds(t) > kLongest_s) {
      good = t;
      continue;
    }
    const Change change = Between(*keypoints, sizes, good, t);
    const bool jumps = change.known && (change.distance > kJump + kJumpSpeed * seconds(t) ||
                                        change.size > kJumpSize * (1 + kJumpSpeed * seconds(t)));
    int returns = t;
    if (jumps) {
      const auto continues = [&](int u) {
        return sizes[u] > 0 && Between(*keypoints, sizes, good, u).Continues(seconds(u));
      };
      int u = t + 1;
      while (u < T && seconds(u) <= kLongest_s && !continues(u)) ++u;
      if (u < T && seconds(u) <= kLongest_s) returns = u;
    }
    for (; t < returns; ++t) {
      for (int k = 0; k < keypoints->num_points(); ++k) keypoints->at(t, k) = Keypoint();
      ++dropped;
    }
    good = t;
  }
  return dropped;
}

}  // namespace bodyloom
