// SPDX-License-Identifier: Apache-2.0
/// Seconds from the presentation timestamps of frames, in the order in which they are shown.
#pragma once

#include <cstdint>
#include <optional>

namespace bodyloom {

class FrameClock {
 public:
  /// A tick is numerator / denominator seconds (the stream's time base). `frame_s`: the usual time between two frames,
  /// more than 0.
  FrameClock(int numerator, int denominator, double frame_s);

  /// Seconds since the first frame, each more than the one before. What files leave out or get wrong is filled in: a
  /// frame without a timestamp comes `frame_s` after the one before, one that is not later half of `frame_s`; and where
  /// the timestamps go back by more than a second (recordings put one behind the other), the clock goes on.
  double Next(std::optional<int64_t> timestamp);

 private:
  double tick_numerator_, tick_denominator_, frame_s_;
  std::optional<int64_t> origin_;
  double shift_s_ = 0, last_s_ = 0;
  bool has_last_ = false;
};

}  // namespace bodyloom
