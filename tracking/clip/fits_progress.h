// SPDX-License-Identifier: Apache-2.0
/// Progress of several fits as one fraction. A header by itself, since people and views are fitted one after another in
/// the same way.
#pragma once

#include <mutex>
#include <numeric>
#include <vector>

#include "tracking/problem/track_options.h"

namespace bodyloom {

/// Options of fits that report to one callback, from one thread at a time. Once it requests a stop, every later fit is
/// stopped too.
class FitsProgress {
 public:
  /// `options` must outlive the fits.
  FitsProgress(const TrackSequenceOptions& options, size_t num_fits)
      : options_(options), num_fits_(static_cast<double>(num_fits)) {}

  /// Options of the next fit, which begins when all before have ended. They refer to this object.
  [[nodiscard]] TrackSequenceOptions NextFit() { return NextFits(1)[0]; }
  /// The same for fits that run at the same time.
  [[nodiscard]] std::vector<TrackSequenceOptions> NextFits(size_t count) {
    ended_ += static_cast<double>(running_.size());
    running_.assign(count, 0);
    std::vector<TrackSequenceOptions> options(count, options_);
    for (size_t i = 0; options_.progress && i < count; ++i) {
      options[i].progress = [this, i](TrackProgress at) {
        const std::lock_guard<std::mutex> lock(reports_);
        running_[i] = at.fraction;
        at.fraction = (ended_ + std::accumulate(running_.begin(), running_.end(), 0.0)) / num_fits_;
        stopped_ = stopped_ || !options_.progress(at);
        return !stopped_;
      };
    }
    return options;
  }
  [[nodiscard]] bool stopped() const { return stopped_; }

 private:
  const TrackSequenceOptions& options_;
  double num_fits_, ended_ = 0;
  std::vector<double> running_;  ///< fractions
  std::mutex reports_;
  bool stopped_ = false;
};

}  // namespace bodyloom
