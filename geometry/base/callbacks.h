// SPDX-License-Identifier: Apache-2.0
/// Callbacks between a pipeline and its caller while it runs, and the errors that the caller distinguishes. A pipeline
/// prints nothing, installs no signal handler and never ends the process.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace bodyloom {

/// The request contradicts itself or lacks something (options that do not go together); the command answers with exit
/// code 2. A file that cannot be used is a std::runtime_error, as everywhere.
class RequestError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Thrown out of a pipeline whose progress callback returned false. What was being written is removed.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

struct PipelineCallbacks {
  /// The name of the work whose progress follows ("tracking 240 frames"), once it is known. A job that runs others
  /// begins several, one after the other.
  std::function<void(const std::string& work)> begin;
  /// Called now and then with the stage at work and how much of the whole work is done, in [0, 1] (0 throughout when
  /// its length is not known); false cancels the job. It may be called from any one thread at a time. Without it the
  /// job runs through.
  std::function<bool(const std::string& stage, double fraction)> progress;
  /// A line that a user should read while the job runs (no newline at its end): what was left out, what was found.
  std::function<void(const std::string& line)> message;

  /// Calls `begin`, if any.
  void Begin(const std::string& work) const {
    if (begin) begin(work);
  }
  /// Calls `progress`, if any, and returns its answer: for code that stops by itself on request.
  [[nodiscard]] bool GoesOn(const std::string& stage, double fraction) const {
    return !progress || progress(stage, fraction);
  }
  /// The same; throws Cancelled instead of returning false.
  void Update(const std::string& stage, double fraction) const {
    if (!GoesOn(stage, fraction)) throw Cancelled();
  }
  /// Calls `message`, if any.
  void Say(const std::string& line) const {
    if (message) message(line);
  }
};

}  // namespace bodyloom
