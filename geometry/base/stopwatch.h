// SPDX-License-Identifier: Apache-2.0
/// Wall-clock time of one operation (Stopwatch); wall-clock and processor time of the stages of a job (StageClock).
#pragma once

#include <chrono>
#include <ctime>
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

/// Time spent in each stage of a job; a stage that occurs several times is summed. Processor time is that of all
/// threads of the program together: of a stage that keeps two cores busy, twice its wall-clock time.
class StageClock {
 public:
  /// Starts a stage and ends the one before, if any.
  void Begin(const std::string& stage) {
    End();
    name_ = stage;
    Lap();
  }
  void End() {
    if (!name_.empty()) Record(std::exchange(name_, {}));
  }
  /// Adds the time since the last Begin(), End() or Record() (or construction) to `stage`; returns its wall-clock
  /// seconds.
  double Record(const std::string& stage) {
    const auto [wall, processor] = Lap();
    size_t i = 0;
    while (i < seconds_.size() && seconds_[i].first != stage) ++i;
    if (i == seconds_.size()) {
      seconds_.emplace_back(stage, 0.);
      processor_seconds_.emplace_back(stage, 0.);
    }
    seconds_[i].second += wall;
    processor_seconds_[i].second += processor;
    return wall;
  }
  /// Wall-clock seconds of the stages that have ended.
  [[nodiscard]] const StageSeconds& seconds() const { return seconds_; }
  /// Processor seconds of the same stages, in the same order.
  [[nodiscard]] const StageSeconds& processor_seconds() const { return processor_seconds_; }
  /// Wall-clock seconds since construction.
  [[nodiscard]] double total() const { return watch_.seconds(); }

 private:
  /// Wall-clock and processor seconds since the last lap.
  std::pair<double, double> Lap() {
    const std::clock_t now = std::clock();
    return {watch_.Lap(), double(now - std::exchange(processor_lap_, now)) / CLOCKS_PER_SEC};
  }

  Stopwatch watch_;
  std::clock_t processor_lap_ = std::clock();
  std::string name_;
  StageSeconds seconds_, processor_seconds_;
};

}  // namespace bodyloom
