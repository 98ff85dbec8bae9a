// SPDX-License-Identifier: Apache-2.0
/// Wall-clock time of one operation (Stopwatch) and of the stages of a job (StageClock), by a monotonic clock.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace bodyloom {

class Stopwatch {
 public:
  /// Seconds since construction.
  [[nodiscard]] double seconds() const { return Between(start_, Clock::now()); }
  /// Seconds since the last call, or since construction.
  double Lap() {
    const Clock::time_point now = Clock::now();
    return Between(std::exchange(lap_start_, now), now);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double Between(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
  }
  Clock::time_point start_ = Clock::now(), lap_start_ = start_;
};

/// Stages and their seconds, in the order in which they first ended.
using StageSeconds = std::vector<std::pair<std::string, double>>;

/// Time spent in each stage of a job; a stage that occurs several times is summed.
class StageClock {
 public:
  /// Starts a stage and ends the one before, if any.
  void Begin(const std::string& stage) {
    End();
    name_ = stage;
    watch_.Lap();
  }
  void End() {
    if (!name_.empty()) Record(std::exchange(name_, {}));
  }
  /// Adds the time since the last Begin(), End() or Book() (or construction) to `stage`; returns it, seconds.
  double Record(const std::string& stage) {
    const double passed = watch_.Lap();
    for (auto& [name, sum] : seconds_) {
      if (name == stage) {
        sum += passed;
        return passed;
      }
    }
    seconds_.emplace_back(stage, passed);
    return passed;
  }
  /// Stages that have ended.
  [[nodiscard]] const StageSeconds& seconds() const { return seconds_; }
  /// Seconds since construction.
  [[nodiscard]] double total() const { return watch_.seconds(); }

 private:
  Stopwatch watch_;
  std::string name_;
  StageSeconds seconds_;
};

}  // namespace bodyloom
