// SPDX-License-Identifier: Apache-2.0
#include "tracking/live/live_history.h"

#include <algorithm>
#include <utility>

#include "geometry/base/check.h"
#include "tracking/initialise/outlier_frames.h"
#include "tracking/initialise/swap_repair.h"
#include "tracking/problem/input_checks.h"
#include "tracking/terms/observability.h"

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
  sample_ = last_seen_ = held_ = held_seen_ = all_;
}

void LiveHistory::Forget() {
  for (KeypointSequence* keypoints : {&all_, &sample_, &last_seen_, &held_, &held_seen_}) *keypoints = Empty();
  sample_step_ = 1;
  since_sample_ = 0;
}

KeypointSequence LiveHistory::Empty() const {
  KeypointSequence empty;
  empty.convention = all_.convention;
  empty.names = all_.names;
  empty.image_width = all_.image_width;
  empty.image_height = all_.image_height;
  return empty;
}

bool LiveHistory::IsCut(const KeypointSequence& before, const KeypointSequence& frame) {
  if (before.num_frames() == 0) return false;
  KeypointSequence pair = before;
  Append(frame, 0, &pair);
  return FindCuts(pair)[1] != 0;
}

Continuity LiveHistory::Add(double timestamp, const std::vector<Keypoint>& points, double hold_s) {
  const size_t K = all_.names.size();
  BODYLOOM_CHECK(points.empty() || points.size() == K, "live: ", points.size(), " 2D joints in a frame, expected ", K);
  KeypointSequence frame = Empty();
  frame.points.assign(K, Keypoint());
  frame.timestamps = {timestamp};
  KeypointSequence nothing = frame;
  if (!points.empty()) frame.points = points;
  DropUnusable(&frame);
  const bool seen = SeenBodySize(frame, 0) > 0;
  const bool gap = last_seen_.num_frames() > 0 && timestamp - last_seen_.timestamps[0] > kMaxGap_s;
  if (held_.num_frames() == 0) {
    if (!IsCut(last_seen_, frame)) {
      Put(std::move(frame));
      return Continuity::kContinues;
    }
    held_begin_ = 0;
  } else {
    KeypointSequence pair = last_seen_;
    Append(frame, 0, &pair);
    if (!gap && ContinuesFrame(pair, 0, 1)) {
      held_ = held_seen_ = Empty();
      Put(std::move(frame));
      return Continuity::kContinues;
    }
    if (IsCut(held_seen_, frame)) held_begin_ = held_.num_frames();
  }
  Append(frame, 0, &held_);
  if (seen) held_seen_ = frame;
  if (!gap && (!seen || (hold_s > 0 && timestamp - held_.timestamps[0] <= hold_s))) {
    Append(nothing, 0, &all_);
    DropOld();
    return Continuity::kHeld;
  }
  const KeypointSequence held = std::move(held_);
  const int begin = held_begin_;
  Forget();
  for (int t = begin; t < held.num_frames(); ++t) {
    KeypointSequence one = Empty();
    Append(held, t, &one);
    Put(std::move(one));
  }
  return Continuity::kCut;
}

void LiveHistory::Put(KeypointSequence frame) {
  if (all_.num_frames() > 0) {
    KeypointSequence last = Recent(kSwapFrames - 1, 1);
    Append(frame, 0, &last);
    RepairSwaps(&last);
    for (int k = 0; k < frame.num_points(); ++k) {  // both joints of a pair are counted
      const Keypoint& repaired = last.at(last.num_frames() - 1, k);
      num_swaps_repaired_ += repaired.confidence > 0 && repaired.x != frame.points[k].x;
      frame.points[k] = repaired;
    }
  }
  Append(frame, 0, &all_);
  DropOld();
  if (SeenBodySize(frame, 0) <= 0) return;
  last_seen_ = frame;
  if (++since_sample_ >= sample_step_) {
    since_sample_ = 0;
    Append(frame, 0, &sample_);
  }
  if (sample_.num_frames() >= max_frames_) {
    KeypointSequence half = Empty();
    for (int t = 0; t < sample_.num_frames(); t += 2) Append(sample_, t, &half);
    sample_ = std::move(half);
    sample_step_ *= 2;
  }
}

void LiveHistory::DropOld() {
  const double oldest = all_.timestamps.back() - seconds_;
  int old = 0;
  while (all_.num_frames() - old > max_frames_ || all_.timestamps[old] < oldest) ++old;
  // Now and then many at once: erasing at the front moves everything behind.
  if (old > max_frames_ / 4) DropFrames(old, &all_);
}

KeypointSequence LiveHistory::Recent(int count, int stride) const {
  KeypointSequence recent = Empty();
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
