// SPDX-License-Identifier: Apache-2.0
/// Repairs detections with left and right exchanged in some frames, and finds cuts.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "geometry/scene/observations.h"

namespace bodyloom {

/// Exchanges each left–right pair back in the frames where it was swapped: a two-state trellis over the clip, in which
/// a jump costs its squared length in body sizes (saturated) and a swapped frame costs a little, so that a pair is only
/// exchanged where both its points jump to each other's place and back. Pairs are found by name (left_x, right_x);
/// shoulders with hips, and eyes with ears, are not tied together.
///
/// Before that whole bodies: a detector that takes a front for a back, in frames [a, b), exchanges all pairs at once. A
/// trellis over the clip has a cost of the joints' accelerations, all pairs together, and one of 15 a second of
/// exchanged frames. Its exchanged frames are put back if shoulders or hips would have turned faster than anybody
/// (body_rods.h) both between a − 1 and a and between b − 1 and b, and they last for at most 3 s. Frames up to the
/// first or the last one are left, since nothing says which side is right. People who turn, however fast, pass through
/// a narrow view that shows it.
///
/// Returns the number of exchanged pairs × frames.
int RepairSwaps(KeypointSequence* keypoints);

inline constexpr double kMaxGap_s = 1;  ///< between frames of one shot

/// Marks frames t that do not continue frame t−1: after a gap of more than kMaxGap_s, or where the whole body jumps by
/// more than half its size within a tenth of a second. The first frame is never a cut.
std::vector<char> FindCuts(const KeypointSequence& keypoints);

/// True if the confidence of a landmark suffices to judge motion by it (0.2).
inline bool IsSeen(const Keypoint& point) {
  return point.confidence >= 0.2F && std::isfinite(point.x) && std::isfinite(point.y);
}

/// Diagonal of the box around the seen landmarks of frame t: the person's size in the image, pixels; 0 with fewer
/// than 4.
double SeenBodySize(const KeypointSequence& keypoints, int t);

/// Finds the path of minimum cost through a trellis: min over s of Σ_t unary(t, s_t) + Σ_t transition(t, s_{t−1}, s_t).
/// unary[t][s] for T steps with any number of states a step (at least one); transition(t, a, b) is the cost of going
/// from state a of step t−1 to state b of step t. Returns T states. O(Σ S_{t−1} S_t); ties go to the lower index.
template <typename Transition>
std::vector<int> Viterbi(const std::vector<std::vector<double>>& unary, const Transition& transition) {
  const size_t T = unary.size();
  if (T == 0) return {};
  std::vector<std::vector<int>> from(T);
  std::vector<double> cost = unary[0], next;
  for (size_t t = 1; t < T; ++t) {
    next.assign(unary[t].size(), std::numeric_limits<double>::infinity());
    from[t].assign(unary[t].size(), 0);
    for (size_t b = 0; b < unary[t].size(); ++b) {
      for (size_t a = 0; a < cost.size(); ++a) {
        if (cost[a] >= next[b]) continue;  // transitions are not negative
        const double c = cost[a] + transition(t, static_cast<int>(a), static_cast<int>(b));
        if (c < next[b]) {
          next[b] = c;
          from[t][b] = static_cast<int>(a);
        }
      }
      next[b] += unary[t][b];
    }
    cost.swap(next);
  }
  std::vector<int> path(T);
  path[T - 1] = static_cast<int>(std::min_element(cost.begin(), cost.end()) - cost.begin());
  for (size_t t = T - 1; t > 0; --t) path[t - 1] = from[t][path[t]];
  return path;
}

}  // namespace bodyloom
