// SPDX-License-Identifier: Apache-2.0
#include "tracking/lifter/lift_keypoints.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "tracking/lifter/lifter_input.h"
#include "tracking/lifter/lifter_network.h"
#include "tracking/lifter/lifter_reading.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSlowest = 14;  ///< frames a second; below it frames are interpolated

/// Frames first, first + stride, … of the clip, with `between` − 1 interpolated frames after each (stride 1 then).
struct SamplingPhase {
  int first = 0, stride = 1, count = 0, between = 1;
  [[nodiscard]] int num_samples() const { return (count - 1) * between + 1; }
};

/// Sampling phases of the frames [begin, end); one only unless `all`.
std::vector<SamplingPhase> PhasesOf(const std::vector<double>& timestamps, int begin, int end, bool all) {
  const int count = end - begin;
  double fps = kLifterRate;
  if (count > 1 && timestamps[end - 1] > timestamps[begin]) {
    std::vector<double> steps;
    for (int t = begin + 1; t < end; ++t) steps.push_back(timestamps[t] - timestamps[t - 1]);
    std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
    fps = 1 / std::max(steps[steps.size() / 2], 1e-6);
  }
  if (fps < kSlowest) {
    const int between = std::clamp(static_cast<int>(std::lround(kLifterRate / fps)), 1, 40);
    return {{begin, 1, count, between}};
  }
  const int stride = std::clamp(static_cast<int>(std::lround(fps / kLifterRate)), 1, count);
  std::vector<SamplingPhase> phases;
  phases.reserve(static_cast<size_t>(stride));
  for (int p = 0; p < (all ? stride : 1); ++p)
    phases.push_back({begin + p, stride, (count - p + stride - 1) / stride, 1});
  return phases;
}

/// All frames' rays in the lifter's order of landmarks.
LifterFrames RaysOf(const KeypointSequence& keypoints, const Camera& camera, bool focal_known) {
  const int T = keypoints.num_frames();
  LifterFrames rays;
  rays.num_frames = T;
  rays.focal_known = focal_known;
  rays.x.assign(size_t(T) * kLifterPoints, 0);
  rays.y = rays.confidence = rays.x;
  for (int k = 0; k < kLifterPoints; ++k) {
    const auto it = std::find(keypoints.names.begin(), keypoints.names.end(), LifterPointNames()[k]);
    if (it == keypoints.names.end()) continue;
    const int column = static_cast<int>(it - keypoints.names.begin());
    for (int t = 0; t < T; ++t) {
      const Keypoint& point = keypoints.at(t, column);
      if (!(point.confidence > 0) || !std::isfinite(point.x) || !std::isfinite(point.y)) continue;
      const Vector2d ray = camera.Unproject({point.x, point.y});
      if (!ray.allFinite()) continue;
      const size_t i = size_t(t) * kLifterPoints + k;
      rays.x[i] = static_cast<float>(ray.x());
      rays.y[i] = static_cast<float>(ray.y());
      rays.confidence[i] = std::min(point.confidence, 1.0F);
    }
  }
  return rays;
}

LifterFrames SamplePhase(const LifterFrames& all, const SamplingPhase& phase) {
  LifterFrames frames;
  frames.focal_known = all.focal_known;
  frames.num_frames = phase.num_samples();
  for (int s = 0; s < frames.num_frames; ++s) {
    const int a = phase.first + (s / phase.between) * phase.stride, part = s % phase.between;
    const int b = part == 0 ? a : a + phase.stride;
    const float w = static_cast<float>(part) / static_cast<float>(phase.between);
    for (int k = 0; k < kLifterPoints; ++k) {
      const size_t i = size_t(a) * kLifterPoints + k, j = size_t(b) * kLifterPoints + k;
      frames.x.push_back((1 - w) * all.x[i] + w * all.x[j]);
      frames.y.push_back((1 - w) * all.y[i] + w * all.y[j]);
      frames.confidence.push_back(std::min(all.confidence[i], all.confidence[j]));
    }
  }
  return frames;
}

/// Fills frames that no phase has sampled, by interpolation between their neighbours.
void FillBetween(const std::vector<char>& read, int begin, int end, std::vector<LiftedFrame>* frames) {
  int last = -1;
  for (int t = begin; t < end; ++t) {
    if (read[t]) {
      last = t;
      continue;
    }
    if (last < 0) continue;
    int next = t;
    while (next < end && !read[next]) ++next;
    if (next == end) {
      (*frames)[t] = (*frames)[last];
      continue;
    }
    (*frames)[t] = InterpolateLifted((*frames)[last], (*frames)[next], static_cast<double>(t - last) / (next - last));
  }
}

}  // namespace

LiftedFrame InterpolateLifted(const LiftedFrame& a, const LiftedFrame& b, double s) {
  LiftedFrame frame = s < 0.5 ? a : b;
  frame.points = (1 - s) * a.points + s * b.points;
  return frame;
}

std::vector<LiftedFrame> LiftKeypoints(const KeypointSequence& keypoints, const Camera& camera, bool focal_known,
                                       const std::vector<char>& cut_before, const LifterWeights& weights,
                                       const LiftOptions& options) {
  const int T = keypoints.num_frames();
  BODYLOOM_CHECK(weights.num_inputs() == kLifterInputs, "lifter: the weights are for ", weights.num_inputs(),
                 " inputs, expected ", kLifterInputs);
  BODYLOOM_CHECK(cut_before.empty() || static_cast<int>(cut_before.size()) == T, "lifter: ", cut_before.size(),
                 " cut marks for ", T, " frames");
  const LifterFrames rays = RaysOf(keypoints, camera, focal_known);
  const auto shows = [&](int t) {
    const auto first = rays.confidence.begin() + std::ptrdiff_t{t} * kLifterPoints;
    return std::any_of(first, first + kLifterPoints, [](float c) { return c > 0; });
  };
  std::vector<LiftedFrame> result(T);
  std::vector<SamplingPhase> phases;
  std::vector<std::pair<int, int>> clips;
  bool any = false;
  for (int begin = 0; begin < T;) {
    int end = begin + 1;
    while (end < T && (cut_before.empty() || !cut_before[end])) ++end;
    for (const SamplingPhase& phase : PhasesOf(keypoints.timestamps, begin, end, options.all_phases))
      phases.push_back(phase);
    clips.emplace_back(begin, end);
    begin = end;
  }
  std::vector<char> read(T, 0);
  ParallelFor(static_cast<int>(phases.size()), options.num_threads, [&](int p) {
    const SamplingPhase& phase = phases[p];
    const LifterInput input = MakeLifterInput(SamplePhase(rays, phase));
    const RowMatrixXf features =
        Eigen::Map<const RowMatrixXf>(input.features.data(), phase.num_samples(), kLifterInputs);
    // Of a slow clip a sample is a frame and those interpolated behind it.
    const int last = options.last_samples > 0 ? (options.last_samples - 1) * phase.between + 1 : 0;
    const RowMatrixXf plain = RunLifter(weights, features, last);
    const RowMatrixXf mirrored = options.mirrored ? RunLifter(weights, MirrorFeatures(features), last) : RowMatrixXf();
    const int skipped = phase.num_samples() - static_cast<int>(plain.rows());
    for (int i = 0; i < phase.count; ++i) {
      const int t = phase.first + i * phase.stride, s = i * phase.between;
      if (s < skipped) continue;
      result[t] = ReadLifter(plain, mirrored, s - skipped, input.camera_from_virtual[s].cast<double>());
      read[t] = 1;
    }
  });
  for (const auto& [begin, end] : clips) FillBetween(read, begin, end, &result);
  for (int t = 0; t < T; ++t) any |= result[t].seen = shows(t);
  if (!any) result.clear();
  return result;
}

}  // namespace bodyloom
