// SPDX-License-Identifier: Apache-2.0
/// Progress of several fits as one fraction. A header by itself, since people and views are fitted one after another in
/// the same way.
#pragma once

#include "tracking/problem/track_options.h"

namespace bodyloom {

/// Options of fits that report to one callback. Once it requests a stop, every later fit is stopped too.
class FitsProgress {
 public:
  /// `options` must outlive the fits.
  FitsProgress(const TrackSequenceOptions& options, size_t num_fits)
      : options_(options), num_fits_(static_cast<double>(num_fits)) {}

  /// Options of the next fit. They refer to this object.
  [[nodiscard]] TrackSequenceOptions NextFit() {
    TrackSequenceOptions options = options_;
    const int done = begun_++;
    if (options_.progress) {
      options.progress = [this, done](TrackProgress at) {
        at.fraction = (done + at.fraction) / num_fits_;
        stopped_ = stopped_ || !options_.progress(at);
        return !stopped_;
      };
    }
    return options;
  }
  [[nodiscard]] bool stopped() const { return stopped_; }

 private:
  const TrackSequenceOptions& options_;
  double num_fits_;
  int begun_ = 0;
  bool stopped_ = false;
};

}  // namespace bodyloom
