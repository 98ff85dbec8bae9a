// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/swap_repair.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "tracking/problem/robust.h"

namespace bodyloom {
namespace {

constexpr float kConfidence = 0.2F;
constexpr double kSwappedCost = 0.6;  ///< of a swapped frame, so that only continuity leads to a swap
constexpr double kJumpKernel = 3;     ///< jumps saturate at this many σ, so that a cut does not cause a swap
constexpr double kSpeed = 3;          ///< body sizes a second: σ of a joint's motion in the image
constexpr double kJitter = 0.02;      ///< body sizes: σ of the detector

}  // namespace

bool IsSeen(const Keypoint& point) {
  return point.confidence >= kConfidence && std::isfinite(point.x) && std::isfinite(point.y);
}

double SeenBodySize(const KeypointSequence& keypoints, int t) {
  Eigen::Array2d low = Eigen::Array2d::Constant(1e30), high = -low;
  int count = 0;
  for (int k = 0; k < keypoints.num_points(); ++k) {
    const Keypoint& point = keypoints.at(t, k);
    if (!IsSeen(point)) continue;
    low = low.min(Eigen::Array2d(point.x, point.y));
    high = high.max(Eigen::Array2d(point.x, point.y));
    ++count;
  }
  return count < 4 ? 0 : (high - low).matrix().norm();
}

int RepairSwaps(KeypointSequence* keypoints) {
  std::vector<std::pair<int, int>> pairs;
  for (int k = 0; k < keypoints->num_points(); ++k) {
    if (keypoints->names[k].rfind("left_", 0) != 0) continue;
    const auto it =
        std::find(keypoints->names.begin(), keypoints->names.end(), "right_" + keypoints->names[k].substr(5));
    if (it != keypoints->names.end()) pairs.emplace_back(k, static_cast<int>(it - keypoints->names.begin()));
  }
  std::vector<double> sizes(keypoints->num_frames());
  for (int t = 0; t < keypoints->num_frames(); ++t) sizes[t] = SeenBodySize(*keypoints, t);
  int repaired = 0;
  for (const auto& [left, right] : pairs) {
    std::vector<int> frames;
    for (int t = 0; t < keypoints->num_frames(); ++t) {
      if (sizes[t] > 0 && IsSeen(keypoints->at(t, left)) && IsSeen(keypoints->at(t, right))) frames.push_back(t);
    }
    const std::vector<std::vector<double>> unary(frames.size(), {0.0, kSwappedCost});
    const auto distance2 = [&](int t, int a, int u, int b) {
      const Keypoint &p = keypoints->at(t, a), &q = keypoints->at(u, b);
      return (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
    };
    const std::vector<int> path = Viterbi(unary, [&, left = left, right = right](size_t i, int a, int b) {
      const int t = frames[i - 1], u = frames[i];
      const double dt = keypoints->timestamps[u] - keypoints->timestamps[t];
      const double sigma = std::max(sizes[t], sizes[u]) * std::hypot(kJitter, kSpeed * dt);
      const int from_left = a == 0 ? left : right, to_left = b == 0 ? left : right;
      const int from_right = a == 0 ? right : left, to_right = b == 0 ? right : left;
      const double s = (distance2(t, from_left, u, to_left) + distance2(t, from_right, u, to_right)) / (sigma * sigma);
      return GemanMcClure(s, kJumpKernel).rho;
    });
    for (size_t i = 0; i < frames.size(); ++i) {
      if (path[i] == 0) continue;
      std::swap(keypoints->at(frames[i], left), keypoints->at(frames[i], right));
      ++repaired;
    }
  }
  return repaired;
}

std::vector<char> FindCuts(const KeypointSequence& keypoints) {
  std::vector<char> cuts(keypoints.num_frames(), 0);
  int previous = -1;  // the last frame that shows a person
  for (int t = 0; t < keypoints.num_frames(); ++t) {
    if (t > 0 && keypoints.timestamps[t] - keypoints.timestamps[t - 1] > kMaxGap_s) cuts[t] = 1;
    const double size = SeenBodySize(keypoints, t);
    if (size <= 0) continue;
    if (previous >= 0 && keypoints.timestamps[t] - keypoints.timestamps[previous] < 0.1) {
      std::vector<double> jumps;
      for (int k = 0; k < keypoints.num_points(); ++k) {
        const Keypoint &p = keypoints.at(previous, k), &q = keypoints.at(t, k);
        if (IsSeen(p) && IsSeen(q)) jumps.push_back(std::hypot(p.x - q.x, p.y - q.y));
      }
      if (jumps.size() >= 4) {
        std::nth_element(jumps.begin(), jumps.begin() + static_cast<std::ptrdiff_t>(jumps.size() / 2), jumps.end());
        if (jumps[jumps.size() / 2] > 0.5 * size) cuts[t] = 1;
      }
    }
    previous = t;
  }
  return cuts;
}

}  // namespace bodyloom
