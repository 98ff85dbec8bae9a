// SPDX-License-Identifier: Apache-2.0
/// Callbacks between a pipeline and its caller while it runs, and the errors that the caller distinguishes. A pipeline
/// prints nothing, installs no signal handler and never ends the process.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace bodyloom {

/// The request contradicts itself or is incomplete (options that do not go together); the command answers with exit
/// code 2. A file that cannot be used is a std::runtime_error, as everywhere.
class RequestError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Thrown out of a pipeline whose progress callback returned false. Partly written output is removed.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

struct PipelineCallbacks {
  /// Called with the name of the work whose progress follows ("tracking 240 frames"), once it is known; several times
  /// by a job that runs others in turn.
  std::function<void(const std::string& work)> begin;
  /// Called at intervals with the current stage and the fraction of the whole work that is done, in [0, 1] (0
  /// throughout when its length is not known); false cancels the job. Called from any thread, but from one at a time.
  /// Without it the job runs to its end.
  std::function<bool(const std::string& stage, double fraction)> progress;
  /// Called with a line for the user while the job runs, such as what was left out or found (no newline at its end).
  std::function<void(const std::string& line)> message;

  /// Calls `begin`, if any.
  void Begin(const std::string& work) const {
    if (begin) begin(work);
  }
  /// Calls `progress`, if any, and returns its result, for callers that return early themselves when it is false.
  [[nodiscard]] bool ReportProgress(const std::string& stage, double fraction) const {
    return !progress || progress(stage, fraction);
  }
  /// The same; throws Cancelled instead of returning false.
  void Update(const std::string& stage, double fraction) const {
    if (!ReportProgress(stage, fraction)) throw Cancelled();
  }
  /// Calls `message`, if any.
  void Message(const std::string& line) const {
    if (message) message(line);
  }
};

}  // namespace bodyloom
