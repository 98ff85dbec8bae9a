// SPDX-License-Identifier: Apache-2.0
/// Progress on stderr: a bar with the remaining time on a terminal, otherwise a line from time to time.
#pragma once

#include <chrono>
#include <iosfwd>
#include <iostream>
#include <string>

#include "geometry/base/callbacks.h"

namespace bodyloom {

class Progress {
 public:
  enum class Style { kBar, kLines, kSilent };

  /// Writes to stderr.
  explicit Progress(std::string title, Style style = DefaultStyle());
  Progress(std::string title, Style style, std::ostream& out);
  /// Ends the line of a bar.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// kBar when stderr is a terminal, else kLines.
  static Style DefaultStyle();

  /// Reports the `fraction` of the whole in [0, 1]; decreasing values are ignored. A bar is redrawn at most ten times a
  /// second; a line is written when the stage changes and every ten seconds.
  void Update(const std::string& stage, double fraction);

  /// Erases the bar so that a line can be printed; the next Update() may draw it again.
  void Wipe();

 private:
  using Clock = std::chrono::steady_clock;
  void Draw(const std::string& stage, double fraction, double elapsed_seconds);

  std::string title_;
  Style style_;
  std::ostream& out_;
  Clock::time_point start_, last_drawn_ = Clock::time_point::min();  ///< start_: of the first Update()
  std::string stage_;
  double first_fraction_ = -1, fraction_ = 0;  ///< -1: no Update() yet
  size_t drawn_width_ = 0;
};

// Interruption without partial files: the first SIGINT or SIGTERM sets a flag that long jobs poll, the second one kills
// the process.

/// Installs the handlers, and ignores SIGPIPE and SIGXFSZ so that a closed pipe or a file-size limit becomes a write
/// error with a message instead of terminating the process silently.
void InstallSignalHandlers();

[[nodiscard]] bool IsInterrupted();

// Callbacks of the command: progress on stderr, messages as lines, cancellation by Ctrl-C.

/// Named jobs (PipelineCallbacks::begin) get a bar or lines on stderr (apps/progress.h), unless `quiet`; unnamed jobs
/// show nothing. The interrupt flag (apps/progress.h) cancels the job. Messages go to `messages`, which must outlive
/// the callbacks. The bar is erased when the last copy of the callbacks is destroyed.
PipelineCallbacks CommandCallbacks(bool quiet = false, std::ostream& messages = std::cout);

/// Returns `job(request, callbacks)`, run with a bar of this title that is erased when the job returns.
template <class Job, class Request>
auto RunWithBar(const std::string& title, const Job& job, const Request& request) {
  const PipelineCallbacks callbacks = CommandCallbacks();
  callbacks.Begin(title);
  return job(request, callbacks);
}

}  // namespace bodyloom
