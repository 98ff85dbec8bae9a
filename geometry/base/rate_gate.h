// SPDX-License-Identifier: Apache-2.0
/// Thins moments in time to a rate.
#pragma once

#include <limits>

namespace bodyloom {

/// Lets moments pass that are at least 1/rate seconds after the last that passed; the first passes. What passes after a
/// moment that passed does not depend on those before it.
class RateGate {
 public:
  /// rate: moments a second; 0 or less: all pass.
  explicit RateGate(double rate) : interval_s_(rate > 0 ? 1 / rate : 0) {}

  /// Times in seconds, in order.
  bool Passes(double time_s) {
    constexpr double kRounding = 1e-9;
    if (time_s < due_s_ - kRounding) return false;
    Reset(time_s);
    return true;
  }
  /// Continues as if this moment had passed.
  void Reset(double time_s) { due_s_ = time_s + interval_s_; }

 private:
  double interval_s_, due_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace bodyloom
