// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/outlier_frames.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tracking/initialise/body_rods.h"
#include "tracking/initialise/swap_repair.h"
#include "tracking/problem/input_checks.h"

namespace bodyloom {
namespace {

constexpr double kLongest_s = 0.5;
constexpr double kJump = 0.15, kJumpSpeed = 4, kJumpSize = 1.8;  // body sizes, body sizes a second, ratio
constexpr double kContinues = 0.1, kContinuesSpeed = 1, kSameSize = 1.5;
constexpr double kLongestUpsideDown_s = 2;
constexpr double kHeadUp = 0.5;  // trunks: by which shoulders are above the hips of whoever is upright
constexpr double kFlat = 0.015;  // body sizes; a person in profile with closed legs is 0.05 across

void Empty(int t, KeypointSequence* keypoints) {
  for (int k = 0; k < keypoints->num_points(); ++k) keypoints->at(t, k) = Keypoint();
}

/// Standard deviation of the seen landmarks across the direction in which they spread most, pixels; infinite with fewer
/// than five.
double Thickness(const KeypointSequence& keypoints, int t) {
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  int count = 0;
  for (const int pass : {0, 1}) {
    for (int k = 0; k < keypoints.num_points(); ++k) {
      const Keypoint& point = keypoints.at(t, k);
      if (!IsSeen(point)) continue;
      const Eigen::Vector2d x(point.x, point.y);
      if (pass == 0) {
        mean += x;
        ++count;
      } else {
        scatter += (x - mean) * (x - mean).transpose() / count;
      }
    }
    if (count < 5) return std::numeric_limits<double>::infinity();
    if (pass == 0) mean /= count;
  }
  const double half = 0.5 * scatter.trace();
  return std::sqrt(std::max(0.0, half - std::sqrt(std::max(0.0, half * half - scatter.determinant()))));
}

int DropFlatFrames(const std::vector<double>& sizes, KeypointSequence* keypoints) {
  std::vector<double> known;
  for (const double size : sizes) {
    if (size > 0) known.push_back(size);
  }
  if (known.empty()) return 0;
  const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
  std::nth_element(known.begin(), middle, known.end());
  std::vector<int> flat;
  for (int t = 0; t < keypoints->num_frames(); ++t) {
    if (Thickness(*keypoints, t) < kFlat * std::max(sizes[t], *middle)) flat.push_back(t);
  }
  if (2 * flat.size() > known.size()) return 0;
  for (const int t : flat) Empty(t, keypoints);
  return static_cast<int>(flat.size());
}

/// Empties frames in which the trunk is upside down between upright ones, with turns to and fro that nobody makes.
int DropUpsideDownFrames(KeypointSequence* keypoints) {
  const std::vector<Eigen::Vector2d> trunk = FindBodyRods(*keypoints).trunk;
  const std::vector<double>& times = keypoints->timestamps;
  const auto is_upright = [&](size_t t) { return trunk[t].y() < -kHeadUp; };
  const auto is_inverted = [&](size_t t) { return trunk[t].y() > kHeadUp; };
  const auto turns = [&](size_t t, size_t u) {
    return SmallestTurn(trunk[t], trunk[u]) > kFasterThanSomersaults * (times[u] - times[t]);
  };
  std::vector<size_t> frames;
  for (size_t t = 0; t < trunk.size(); ++t) {
    if (trunk[t].allFinite()) frames.push_back(t);
  }
  int dropped = 0;
  for (size_t i = 1; i < frames.size(); ++i) {
    const size_t before = frames[i - 1], begin = frames[i];
    if (!is_upright(before) || !is_inverted(begin) || !turns(before, begin)) continue;
    size_t j = i + 1;
    while (j < frames.size() && !is_upright(frames[j]) && !turns(frames[j - 1], frames[j])) ++j;
    if (j == frames.size() || !is_upright(frames[j]) || !turns(frames[j - 1], frames[j])) continue;
    if (times[frames[j]] - times[begin] > kLongestUpsideDown_s) continue;
    for (size_t t = begin; t < frames[j]; ++t) {
      Empty(int(t), keypoints);
      ++dropped;
    }
    i = j;
  }
  return dropped;
}

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

int RemoveOutlierFrames(KeypointSequence* keypoints) {
  const int T = keypoints->num_frames();
  int dropped = DropUpsideDownFrames(keypoints), good = -1;
  std::vector<double> sizes(T);
  for (int t = 0; t < T; ++t) sizes[t] = SeenBodySize(*keypoints, t);
  dropped += DropFlatFrames(sizes, keypoints);
  if (dropped > 0) {
    for (int t = 0; t < T; ++t) sizes[t] = SeenBodySize(*keypoints, t);
  }
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
      Empty(t, keypoints);
      ++dropped;
    }
    good = t;
  }
  return dropped;
}

CleanedKeypoints CleanKeypoints(KeypointSequence* keypoints) {
  DropUnusable(keypoints);
  CleanedKeypoints cleaned;
  cleaned.impossible_frames = RemoveOutlierFrames(keypoints);
  cleaned.swaps = RepairSwaps(keypoints);
  return cleaned;
}

}  // namespace bodyloom
