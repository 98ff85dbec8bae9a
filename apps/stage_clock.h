// SPDX-License-Identifier: Apache-2.0
/// Where the time went, by stage in the order of running.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace bodyloom {

using StageSeconds = std::vector<std::pair<std::string, double>>;

class StageClock {
 public:
  /// Ends the stage before, if any.
  void Begin(const std::string& stage) {
    End();
    name_ = stage;
    stage_start_ = Clock::now();
  }
  void End() {
    if (!name_.empty()) {
      seconds_.emplace_back(name_, std::chrono::duration<double>(Clock::now() - stage_start_).count());
      name_.clear();
    }
  }
  /// The finished stages.
  [[nodiscard]] const StageSeconds& seconds() const { return seconds_; }
  /// Since construction.
  [[nodiscard]] double total() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now(), stage_start_ = start_;
  std::string name_;
  StageSeconds seconds_;
};

}  // namespace bodyloom
