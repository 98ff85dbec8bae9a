// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/metrics/temporal_lpips.h"

#include <algorithm>
#include <cmath>

namespace bodyloom {

TemporalLpips::Frame TemporalLpips::Add(const Image& result, const Image& truth) {
  const LpipsFeatures result_features = lpips_.Features(result), truth_features = lpips_.Features(truth);
  Frame frame;
  const LpipsValue distance = lpips_.Distance(result_features, truth_features);
  frame.lpips = distance.value;
  frame.random_features = distance.random_features;
  if (follows_) {
    frame.tlpips = std::abs(lpips_.Distance(result_features, last_result_).value -
                            lpips_.Distance(truth_features, last_truth_).value);
    sum_tlpips_ += *frame.tlpips;
    ++pairs_;
  }
  sum_lpips_ += frame.lpips;
  last_result_ = result_features;
  last_truth_ = truth_features;
  follows_ = true;
  ++frames_;
  return frame;
}

TemporalLpipsMean TemporalLpips::Mean() const {
  return {frames_, sum_lpips_ / std::max(1, frames_), sum_tlpips_ / std::max(1, pairs_), lpips_.has_random_features()};
}

}  // namespace bodyloom
