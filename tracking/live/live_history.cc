// SPDX-License-Identifier: Apache-2.0
#include "tracking/live/live_history.h"

#include <algorithm>
#include <utility>

#include "geometry/check.h"
#include "tracking/initialise/swap_repair.h"
#include "tracking/input_checks.h"
#include "tracking/observability.h"

namespace bodyloom {
namespace {

constexpr int kSwapFrames = 7;

void Append(const KeypointSequence& from, int t, KeypointSequence* to) {
  const auto K = static_cast<std::ptrdiff_t>(from.names.size());
  to->points.insert(to->points.end(), from.points.begin() + t * K, from.points.begin() + (t + 1) * K);
  to->timestamps.push_back(from.timestamps[t]);
}

void DropFrames(int count, KeypointSequence* keypoints) {
  const auto K = static_cast<std::ptrdiff_t>(keypoints->names.size());
  keypoints->points.erase(keypoints->points.begin(), keypoints->points.begin() + count * K);
  keypoints->timestamps.erase(keypoints->timestamps.begin(), keypoints->timestamps.begin() + count);
}

}  // namespace

LiveHistory::LiveHistory(std::vector<std::string> names, int image_width, int image_height, double seconds,
                         int max_frames)
    : seconds_(seconds), max_frames_(max_frames) {
  all_.convention = "live";
  all_.names = std::move(names);
  all_.image_width = image_width;
  all_.image_height = image_height;
  sample_ = last_seen_ = all_;
}

void LiveHistory::Forget() {
  for (KeypointSequence* keypoints : {&all_, &sample_, &last_seen_}) {
    keypoints->points.clear();
    keypoints->timestamps.clear();
  }
  sample_step_ = 1;
  since_sample_ = 0;
}

bool LiveHistory::Add(double timestamp, const std::vector<Keypoint>& points) {
  const size_t K = all_.names.size();
  BODYLOOM_CHECK(points.empty() || points.size() == K, "live: ", points.size(), " 2D joints in a frame, expected ", K);
  KeypointSequence frame = all_;
  frame.points.assign(K, Keypoint());
  frame.timestamps = {timestamp};
  if (!points.empty()) frame.points = points;
  DropUnusable(&frame);
  bool cut = false;
  if (last_seen_.num_frames() > 0) {
    KeypointSequence pair = last_seen_;
    Append(frame, 0, &pair);
    cut = FindCuts(pair)[1] != 0;
  }
  if (cut) Forget();
  if (all_.num_frames() > 0) {
    KeypointSequence last = Recent(kSwapFrames - 1, 1);
    Append(frame, 0, &last);
    RepairSwaps(&last);
    for (size_t k = 0; k < K; ++k) {  // both joints of a pair are counted
      const Keypoint& repaired = last.at(last.num_frames() - 1, static_cast<int>(k));
      num_swaps_repaired_ += repaired.confidence > 0 && repaired.x != frame.points[k].x;
      frame.points[k] = repaired;
    }
  }
  Append(frame, 0, &all_);
  int old = 0;
  while (all_.num_frames() - old > max_frames_ || all_.timestamps[old] < timestamp - seconds_) ++old;
  // Now and then many at once: erasing at the front moves everything behind.
  if (old > max_frames_ / 4) DropFrames(old, &all_);
  if (SeenBodySize(frame, 0) > 0) {
    last_seen_ = frame;
    if (++since_sample_ >= sample_step_) {
      since_sample_ = 0;
      Append(frame, 0, &sample_);
    }
    if (sample_.num_frames() >= max_frames_) {
      KeypointSequence half = frame;
      half.points.clear();
      half.timestamps.clear();
      for (int t = 0; t < sample_.num_frames(); t += 2) Append(sample_, t, &half);
      sample_ = std::move(half);
      sample_step_ *= 2;
    }
  }
  return cut;
}

KeypointSequence LiveHistory::Recent(int count, int stride) const {
  KeypointSequence recent;
  recent.convention = all_.convention;
  recent.names = all_.names;
  recent.image_width = all_.image_width;
  recent.image_height = all_.image_height;
  const int newest = all_.num_frames() - 1;
  for (int i = std::min(count - 1, newest / stride); i >= 0; --i) Append(all_, newest - i * stride, &recent);
  return recent;
}

bool LiveHistory::NewestIsSeen() const {
  const int t = all_.num_frames() - 1;
  for (int k = 0; t >= 0 && k < all_.num_points(); ++k) {
    if (all_.at(t, k).confidence >= kMinConfidence) return true;
  }
  return false;
}

double LiveHistory::TimeStep() const {
  std::vector<double> steps;
  for (int t = std::max(1, all_.num_frames() - 9); t < all_.num_frames(); ++t) {
    steps.push_back(all_.timestamps[t] - all_.timestamps[t - 1]);
  }
  if (steps.empty()) return 0;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  return steps[steps.size() / 2];
}

}  // namespace bodyloom
