// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/metrics/temporal_lpips.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bodyloom/neural/image_tensor.h"

namespace bodyloom {

double TemporalLpips::Change(const Seen& now, const Seen& before, int before_x, int before_y) const {
  if (before_x == 0 && before_y == 0) return lpips_.Distance(now.features, before.features).value;
  const Image moved = ToImage(Shifted(ToTensor(before.image), before_x, before_y));
  return lpips_.Distance(now.features, lpips_.Features(moved)).value;
}

TemporalLpips::Frame TemporalLpips::Add(const Image& result, const Image& truth, int before_x, int before_y) {
  Seen seen_result = {result, lpips_.Features(result)}, seen_truth = {truth, lpips_.Features(truth)};
  Frame frame;
  const LpipsValue distance = lpips_.Distance(seen_result.features, seen_truth.features);
  frame.lpips = distance.value;
  frame.random_features = distance.random_features;
  if (follows_) {
    frame.tlpips = std::abs(Change(seen_result, last_result_, before_x, before_y) -
                            Change(seen_truth, last_truth_, before_x, before_y));
    sum_tlpips_ += *frame.tlpips;
    ++pairs_;
  }
  sum_lpips_ += frame.lpips;
  last_result_ = std::move(seen_result);
  last_truth_ = std::move(seen_truth);
  follows_ = true;
  ++frames_;
  return frame;
}

TemporalLpipsMean TemporalLpips::Mean() const {
  return {frames_, sum_lpips_ / std::max(1, frames_), sum_tlpips_ / std::max(1, pairs_), pairs_,
          lpips_.has_random_features()};
}

}  // namespace bodyloom
