// SPDX-License-Identifier: Apache-2.0
#include "neural/metrics/temporal_lpips.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "neural/base/image_tensor.h"

namespace bodyloom {

double TemporalLpipsOf(const Lpips& lpips, const LpipsFeatures& result, const LpipsFeatures& result_before,
                       const LpipsFeatures& truth, const LpipsFeatures& truth_before) {
  return std::abs(lpips.Distance(result, result_before).value - lpips.Distance(truth, truth_before).value);
}

LpipsFeatures TemporalLpips::Moved(const Seen& rendered, int x, int y) const {
  if (x == 0 && y == 0) return rendered.features;
  return lpips_.Features(ToImage(Shifted(ToTensor(rendered.image), x, y)));
}

TemporalLpips::Frame TemporalLpips::Add(const Image& result, const Image& truth, int before_x, int before_y) {
  Seen seen_result = {result, lpips_.Features(result)}, seen_truth = {truth, lpips_.Features(truth)};
  Frame frame;
  const LpipsValue distance = lpips_.Distance(seen_result.features, seen_truth.features);
  frame.lpips = distance.value;
  frame.random_features = distance.random_features;
  if (follows_) {
    frame.tlpips = TemporalLpipsOf(lpips_, seen_result.features, Moved(last_result_, before_x, before_y),
                                   seen_truth.features, Moved(last_truth_, before_x, before_y));
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
