// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/body_rods.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "geometry/base/percentile.h"
#include "tracking/initialise/swap_repair.h"

namespace bodyloom {
namespace {

constexpr double kNearby_s = 1;
constexpr double kLengthPercentile = 90;
constexpr double kShortestShoulders = 0.5, kShortestHips = 0.3;  ///< trunks

const Eigen::Vector2d kNoRod = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());

/// The pixel of a landmark in T frames; NaN where it is not seen.
std::vector<Eigen::Vector2d> PathOf(const std::string& name, const KeypointSequence& keypoints) {
  std::vector<Eigen::Vector2d> path(size_t(keypoints.num_frames()), kNoRod);
  const auto found = std::find(keypoints.names.begin(), keypoints.names.end(), name);
  if (found == keypoints.names.end()) return path;
  for (int t = 0; t < keypoints.num_frames(); ++t) {
    const Keypoint& point = keypoints.at(t, int(found - keypoints.names.begin()));
    if (IsSeen(point)) path[size_t(t)] = {point.x, point.y};
  }
  return path;
}

/// Of two points, or the one that is seen.
Eigen::Vector2d MiddleOf(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return !a.allFinite() ? b : !b.allFinite() ? a : Eigen::Vector2d(0.5 * (a + b));
}

/// The largest length within kNearby_s of each frame, ignoring NaN; NaN where there is none.
std::vector<double> LargestNearby(const std::vector<Eigen::Vector2d>& lines, const std::vector<double>& times) {
  std::vector<double> largest(lines.size(), std::numeric_limits<double>::quiet_NaN());
  size_t begin = 0;
  for (size_t t = 0; t < lines.size(); ++t) {
    while (times[begin] < times[t] - kNearby_s) ++begin;
    for (size_t u = begin; u < lines.size() && times[u] <= times[t] + kNearby_s; ++u) {
      largest[t] = std::fmax(largest[t], lines[u].norm());
    }
  }
  return largest;
}

/// Divides lines across the body by their length, in proportion to the trunk.
void Scale(const std::vector<double>& trunk_px, double shortest, std::vector<Eigen::Vector2d>* lines) {
  std::vector<double> shares;
  for (size_t t = 0; t < lines->size(); ++t) {
    const double share = (*lines)[t].norm() / trunk_px[t];
    if (std::isfinite(share)) shares.push_back(share);
  }
  const double length = shares.empty() ? shortest : std::max(shortest, Percentile(shares, kLengthPercentile));
  for (size_t t = 0; t < lines->size(); ++t) (*lines)[t] /= length * trunk_px[t];
}

}  // namespace

BodyRods FindBodyRods(const KeypointSequence& keypoints) {
  const std::vector<Eigen::Vector2d> l_shoulder = PathOf("left_shoulder", keypoints),
                                     r_shoulder = PathOf("right_shoulder", keypoints),
                                     l_hip = PathOf("left_hip", keypoints), r_hip = PathOf("right_hip", keypoints);
  BodyRods rods;
  for (size_t t = 0; t < l_hip.size(); ++t) {
    rods.trunk.emplace_back(MiddleOf(l_shoulder[t], r_shoulder[t]) - MiddleOf(l_hip[t], r_hip[t]));
    rods.shoulders.emplace_back(l_shoulder[t] - r_shoulder[t]);
    rods.hips.emplace_back(l_hip[t] - r_hip[t]);
  }
  const std::vector<double> trunk_px = LargestNearby(rods.trunk, keypoints.timestamps);
  Scale(trunk_px, kShortestShoulders, &rods.shoulders);
  Scale(trunk_px, kShortestHips, &rods.hips);
  for (size_t t = 0; t < rods.trunk.size(); ++t) rods.trunk[t] /= trunk_px[t];
  return rods;
}

double SmallestTurn(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d p = a / std::max(1.0, a.norm()), q = b / std::max(1.0, b.norm());
  const double along = std::sqrt(std::max(0.0, 1 - p.squaredNorm()) * std::max(0.0, 1 - q.squaredNorm()));
  return std::acos(std::clamp(p.dot(q) + along, -1.0, 1.0));
}

}  // namespace bodyloom
