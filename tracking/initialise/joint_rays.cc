// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/joint_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace bodyloom::hypotheses_internal {

Lengths::Lengths(const MatrixX3d& rest_points) : rest(rest_points) {
  torso =
      ((rest.row(kLeftShoulder) + rest.row(kRightShoulder)) - (rest.row(kLeftHip) + rest.row(kRightHip))).norm() / 2;
  for (int l = 0; l < 4; ++l) {
    upper[l] = (rest.row(kLimbs[l][1]) - rest.row(kLimbs[l][0])).norm();
    lower[l] = (rest.row(kLimbs[l][2]) - rest.row(kLimbs[l][1])).norm();
  }
}

std::vector<Rays> RaysOfFrames(const KeypointSequence& keypoints, const Camera& camera, const std::vector<int>& frames,
                               const JointHypothesesOptions& options) {
  std::array<int, 17> column;
  for (int k = 0; k < 17; ++k) {
    const auto it = std::find(keypoints.names.begin(), keypoints.names.end(), CocoNames()[k]);
    column[k] = it == keypoints.names.end() ? -1 : static_cast<int>(it - keypoints.names.begin());
  }
  std::vector<Rays> result;
  for (int t : frames) {
    Rays rays;
    for (int k = 0; k < 17; ++k) {
      rays.ray[k].setConstant(std::numeric_limits<double>::quiet_NaN());
      if (column[k] < 0) continue;
      const Keypoint& point = keypoints.at(t, column[k]);
      if (!(point.confidence > 0) || !std::isfinite(point.x) || !std::isfinite(point.y)) continue;
      rays.ray[k] = camera.Unproject({point.x, point.y});
      rays.confidence[k] = point.confidence;
      rays.seen[k] = point.confidence >= options.confidence && rays.ray[k].allFinite();
    }
    for (const auto& [a, b] : {std::pair(kLeftShoulder, kRightShoulder), std::pair(kLeftHip, kRightHip)}) {
      if (!options.hidden_pairs || rays.seen[a] == rays.seen[b]) continue;
      const int from = rays.seen[a] ? a : b, to = rays.seen[a] ? b : a;
      rays.ray[to] = rays.ray[from];
      rays.seen[to] = true;
    }
    result.push_back(rays);
  }
  return result;
}

std::vector<double> RootDepths(const std::vector<Rays>& rays, const std::vector<double>& times,
                               const Lengths& lengths) {
  const size_t T = rays.size();
  std::vector<double> size(T, std::numeric_limits<double>::quiet_NaN());
  const double body = lengths.torso + (lengths.upper[2] + lengths.upper[3] + lengths.lower[2] + lengths.lower[3]) / 2;
  for (size_t t = 0; t < T; ++t) {
    const Rays& r = rays[t];
    if (!r.has_torso()) continue;
    const double torso =
        ((r.ray[kLeftShoulder] + r.ray[kRightShoulder]) - (r.ray[kLeftHip] + r.ray[kRightHip])).norm() / 2;
    double legs = 0;
    int count = 0;
    for (int l = 2; l < 4; ++l) {
      if (!r.seen[kLimbs[l][1]] || !r.seen[kLimbs[l][2]]) continue;
      legs += (r.ray[kLimbs[l][1]] - r.ray[kLimbs[l][0]]).norm() + (r.ray[kLimbs[l][2]] - r.ray[kLimbs[l][1]]).norm();
      ++count;
    }
    // Without legs the torso alone gives the body's length.
    size[t] = count > 0 ? torso + legs / count : torso * body / lengths.torso;
  }
  // Frames within `half_window` seconds of frame t: [first, end).
  const auto window = [&](size_t t, double half_window) {
    const auto first = std::lower_bound(times.begin(), times.end(), times[t] - half_window);
    const auto end = std::upper_bound(first, times.end(), times[t] + half_window);
    return std::pair(static_cast<size_t>(first - times.begin()), static_cast<size_t>(end - times.begin()));
  };
  const auto percentile = [&](size_t t, double half_window, double q) {
    std::vector<double> values;
    const auto [first, end] = window(t, half_window);
    for (size_t u = first; u < end; ++u) {
      if (std::isfinite(size[u])) values.push_back(size[u]);
    }
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    const size_t k = static_cast<size_t>(q * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(k), values.end());
    return values[k];
  };
  std::vector<double> envelope(T), depth(T);
  for (size_t t = 0; t < T; ++t) {
    envelope[t] = percentile(t, 1.5, 0.85);
    if (!std::isfinite(envelope[t])) envelope[t] = percentile(t, std::numeric_limits<double>::infinity(), 0.85);
  }
  for (size_t t = 0; t < T; ++t) {
    double sum = 0, weight = 0;
    const auto [first, end] = window(t, 1.5);
    for (size_t u = first; u < end; ++u) {
      const double w = 1 - std::abs(times[u] - times[t]) / 1.5;
      if (w > 0) {
        sum += w * envelope[u];
        weight += w;
      }
    }
    depth[t] = body * weight / sum;
  }
  return depth;
}

}  // namespace bodyloom::hypotheses_internal
