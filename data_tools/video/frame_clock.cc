// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/video/frame_clock.h"

namespace bodyloom {

FrameClock::FrameClock(int numerator, int denominator, double frame_s)
    : tick_numerator_(numerator), tick_denominator_(denominator), frame_s_(frame_s) {}

double FrameClock::Next(std::optional<int64_t> timestamp) {
  double seconds = last_s_ + (has_last_ ? frame_s_ : 0);
  int64_t ticks = 0;
  if (timestamp && !origin_) {
    origin_ = timestamp;
    shift_s_ = seconds;
  }
  if (timestamp && !__builtin_sub_overflow(*timestamp, *origin_, &ticks)) {
    const double shown = static_cast<double>(ticks) * tick_numerator_ / tick_denominator_ + shift_s_;
    if (!has_last_ || shown > last_s_) {
      seconds = shown;
    } else if (shown < last_s_ - 1) {
      shift_s_ += seconds - shown;
    } else {
      seconds = last_s_ + frame_s_ / 2;
    }
  }
  last_s_ = seconds;
  has_last_ = true;
  return seconds;
}

}  // namespace bodyloom
