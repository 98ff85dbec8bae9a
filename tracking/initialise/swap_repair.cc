// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/swap_repair.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "tracking/initialise/body_rods.h"
#include "tracking/problem/robust.h"

namespace bodyloom {
namespace {

constexpr double kSwappedCost = 0.6;  ///< of a swapped frame, so that only continuity leads to a swap
constexpr double kJumpKernel = 3;     ///< jumps saturate at this many σ, so that a cut does not cause a swap
constexpr double kSpeed = 3;          ///< body sizes a second: σ of a joint's motion in the image
constexpr double kJitter = 0.02;      ///< body sizes: σ of the detector

constexpr double kExchangedCost = 15;     ///< a second: of a body whose left and right are exchanged
constexpr double kNoMotion_s = 0.2;       ///< frames farther apart do not tell how joints move
constexpr double kAcceleration = 20;      ///< body sizes a second squared: σ of a joint's motion
constexpr double kLongestExchange_s = 3;  ///< longer ones may be turns that the detector saw late

using PointPairs = std::vector<std::pair<int, int>>;

/// Landmarks left_x and right_x.
PointPairs FindPairs(const std::vector<std::string>& names) {
  PointPairs pairs;
  for (size_t k = 0; k < names.size(); ++k) {
    if (!names[k].starts_with("left_")) continue;
    const auto it = std::find(names.begin(), names.end(), "right_" + names[k].substr(5));
    if (it != names.end()) pairs.emplace_back(int(k), int(it - names.begin()));
  }
  return pairs;
}

/// Whole bodies with left and right exchanged: finds them by the motion of all pairs at once.
class ExchangedBodies {
 public:
  ExchangedBodies(const std::vector<double>& sizes, const PointPairs& pairs, KeypointSequence* keypoints)
      : sizes_(sizes), pairs_(pairs), keypoints_(*keypoints), rods_(FindBodyRods(*keypoints)) {
    for (int t = 0; t < keypoints_.num_frames(); ++t) {
      const size_t i = size_t(t);
      if (sizes[i] > 0 && (rods_.shoulders[i].allFinite() || rods_.hips[i].allFinite())) frames_.push_back(t);
    }
  }

  /// Exchanges them back; returns the number of pairs × frames.
  int Repair() {
    const size_t n = frames_.size();
    std::vector<char> turns(n, 0);  // impossibly, from the frame before
    for (size_t i = 1; i < n; ++i) turns[i] = IsImpossible(frames_[i - 1], frames_[i]) ? 1 : 0;
    if (std::count(turns.begin(), turns.end(), 1) == 0) return 0;
    const std::vector<int> path = CheapestPath();
    int repaired = 0;
    for (size_t begin = 0, end = 0; begin < n; begin = end) {
      while (end < n && path[end] % 2 == path[begin] % 2) ++end;
      if (path[begin] % 2 == 0) continue;
      if (turns[begin] == 0 || turns[end] == 0 || Time(frames_[end]) - Time(frames_[begin]) > kLongestExchange_s)
        continue;
      for (int t = frames_[begin]; t <= frames_[end - 1]; ++t) repaired += Exchange(t);
    }
    return repaired;
  }

 private:
  [[nodiscard]] double Time(int t) const { return keypoints_.timestamps[size_t(t)]; }

  [[nodiscard]] bool IsImpossible(int t, int u) const {
    const double largest = kFasterThanSpins * (Time(u) - Time(t));
    return SmallestTurn(rods_.shoulders[size_t(t)], rods_.shoulders[size_t(u)]) > largest ||
           SmallestTurn(rods_.hips[size_t(t)], rods_.hips[size_t(u)]) > largest;
  }

  /// State 2a + b of each frame: b is 1 where it is exchanged, a where the one before is. First and last are not.
  [[nodiscard]] std::vector<int> CheapestPath() const {
    std::vector<std::vector<double>> unary;
    for (size_t i = 0; i < frames_.size(); ++i) {
      const double seconds = i == 0 ? 0 : std::min(kNoMotion_s, Time(frames_[i]) - Time(frames_[i - 1]));
      unary.push_back({0, kExchangedCost * seconds, 0, kExchangedCost * seconds});
    }
    unary.front()[1] = unary.front()[3] = unary.back()[1] = unary.back()[3] = std::numeric_limits<double>::infinity();
    return Viterbi(unary, [this](size_t i, int from, int to) {
      if (from % 2 != to / 2) return std::numeric_limits<double>::infinity();
      return i < 2 ? 0 : CostOfMotion(i, from / 2 != 0, from % 2 != 0, to % 2 != 0);
    });
  }

  /// Of the joints over three frames, the last of which is frames_[i]: their departure from even motion.
  [[nodiscard]] double CostOfMotion(size_t i, bool first, bool second, bool third) const {
    const int t = frames_[i - 2], u = frames_[i - 1], v = frames_[i];
    const double before = Time(u) - Time(t), after = Time(v) - Time(u);
    if (std::max(before, after) > kNoMotion_s) return 0;
    const double ratio = after / before, size = std::max({sizes_[size_t(t)], sizes_[size_t(u)], sizes_[size_t(v)]});
    const double jitter = kJitter * std::sqrt(1 + (1 + ratio) * (1 + ratio) + ratio * ratio);
    const double sigma = size * std::hypot(jitter, 0.5 * kAcceleration * after * (before + after));
    double cost = 0;
    for (const auto& [left, right] : pairs_) {
      const auto at = [&, left = left, right = right](int frame, bool is_left, bool exchanged) -> const Keypoint& {
        return keypoints_.at(frame, is_left == exchanged ? right : left);
      };
      double squares = 0;
      bool seen = true;
      for (const bool is_left : {true, false}) {
        const Keypoint &a = at(t, is_left, first), &b = at(u, is_left, second), &c = at(v, is_left, third);
        seen = seen && IsSeen(a) && IsSeen(b) && IsSeen(c);
        squares += std::pow(c.x - b.x - ratio * (b.x - a.x), 2) + std::pow(c.y - b.y - ratio * (b.y - a.y), 2);
      }
      if (seen) cost += GemanMcClure(squares / (sigma * sigma), kJumpKernel).rho;
    }
    return cost;
  }

  int Exchange(int t) {
    int exchanged = 0;
    for (const auto& [left, right] : pairs_) {
      std::swap(keypoints_.at(t, left), keypoints_.at(t, right));
      exchanged += IsSeen(keypoints_.at(t, left)) && IsSeen(keypoints_.at(t, right)) ? 1 : 0;
    }
    return exchanged;
  }

  const std::vector<double>& sizes_;
  const PointPairs& pairs_;
  KeypointSequence& keypoints_;
  BodyRods rods_;
  std::vector<int> frames_;  ///< that show the shoulders or the hips
};

}  // namespace

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
  const PointPairs pairs = FindPairs(keypoints->names);
  std::vector<double> sizes(keypoints->num_frames());
  for (int t = 0; t < keypoints->num_frames(); ++t) sizes[t] = SeenBodySize(*keypoints, t);
  int repaired = ExchangedBodies(sizes, pairs, keypoints).Repair();
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
