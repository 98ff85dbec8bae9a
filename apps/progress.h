// SPDX-License-Identifier: Apache-2.0
/// Progress on stderr: a bar with the time left on a terminal, a plain line now and then anywhere else.
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

  /// On stderr.
  explicit Progress(std::string title, Style style = DefaultStyle());
  Progress(std::string title, Style style, std::ostream& out);
  /// Finishes the line of a bar.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// kBar when stderr is a terminal, else kLines.
  static Style DefaultStyle();

  /// `fraction` of the whole in [0, 1]; a smaller one than before is taken for the one before. A bar is redrawn at most
  /// ten times a second; a line is written when the stage changes and every ten seconds.
  void Update(const std::string& stage, double fraction);

  /// Takes a bar off the screen, so that a line can be printed; the next Update() may draw it again.
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

// Ctrl-C without half files: the first SIGINT or SIGTERM raises a flag that long work polls, the second one kills.

/// Installs the handlers, and ignores SIGPIPE and SIGXFSZ so that a closed pipe or a file-size limit becomes a write
/// error with a message instead of a silent death.
void InstallSignalHandlers();

[[nodiscard]] bool IsInterrupted();

// Callbacks of the command: a pipeline's reports on a terminal, progress on stderr, messages as lines; Ctrl-C cancels
// it.

/// Work that has a name (PipelineCallbacks::begin) gets a bar or lines on stderr (apps/progress.h), nothing when
/// `quiet`; work without one shows nothing. A raised interrupt flag (apps/progress.h) cancels the job. Messages go to
/// `messages`, which must outlive the callbacks. The bar is wiped when the last copy of the callbacks goes.
PipelineCallbacks CommandCallbacks(bool quiet = false, std::ostream& messages = std::cout);

/// The answer of `job(request, callbacks)`, run under a bar of this title, which is gone when it returns.
template <class Job, class Request>
auto RunWithBar(const std::string& title, const Job& job, const Request& request) {
  const PipelineCallbacks callbacks = CommandCallbacks();
  callbacks.Begin(title);
  return job(request, callbacks);
}

}  // namespace bodyloom
