// SPDX-License-Identifier: Apache-2.0
/// How far a batch is, on stderr: for a reader (apps/progress.h), or a line of JSON now and then for a program.
#pragma once

#include <chrono>
#include <iosfwd>
#include <memory>
#include <string>

#include "apps/progress.h"
#include "bodyloom/pipelines/batch/run_batch.h"

namespace bodyloom {

class BatchProgressPrinter {
 public:
  /// `style`: text, json or none.
  BatchProgressPrinter(const std::string& style, std::ostream& out);

  /// JSON: {"clip", "stage", "fraction", "ended", "all", "whole"}, when a clip begins and once a second.
  void Update(const BatchProgress& at);
  /// Takes a bar off the screen, so that a line can be printed.
  void Wipe();

 private:
  using Clock = std::chrono::steady_clock;
  std::ostream& out_;
  bool json_;
  std::unique_ptr<Progress> progress_;
  Clock::time_point last_ = Clock::time_point::min();
};

}  // namespace bodyloom
