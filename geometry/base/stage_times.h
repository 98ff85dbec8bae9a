// SPDX-License-Identifier: Apache-2.0
/// Wall-clock time and processor time of the stages of a job.
#pragma once

#include <ctime>
#include <string>
#include <utility>

#include "geometry/base/stopwatch.h"

namespace bodyloom {

/// Processor time is that of all threads of the program together: of a stage that keeps two cores busy, twice its
/// wall-clock time. Both lists hold the same stages in the same order; a stage that occurs several times is summed.
class StageTimes {
 public:
  /// Starts a stage and ends the one before, if any.
  void Begin(const std::string& stage) {
    End();
    name_ = stage;
    clock_.Begin(stage);
    start_ = std::clock();
  }
  void End() {
    if (name_.empty()) return;
    const double passed = double(std::clock() - start_) / CLOCKS_PER_SEC;
    clock_.End();
    processor_seconds_.resize(clock_.seconds().size());
    for (size_t i = 0; i < processor_seconds_.size(); ++i) {
      auto& [stage, sum] = processor_seconds_[i];
      stage = clock_.seconds()[i].first;
      if (stage == name_) sum += passed;
    }
    name_.clear();
  }

  /// Stages that have ended.
  [[nodiscard]] const StageSeconds& seconds() const { return clock_.seconds(); }
  [[nodiscard]] const StageSeconds& processor_seconds() const { return processor_seconds_; }
  /// Wall-clock seconds since construction.
  [[nodiscard]] double total() const { return clock_.total(); }

 private:
  StageClock clock_;
  StageSeconds processor_seconds_;
  std::string name_;
  std::clock_t start_ = 0;
};

}  // namespace bodyloom
