// SPDX-License-Identifier: Apache-2.0
/// Exit codes of the command: those that scripts may rely on, and the exceptions that lead to them.
#pragma once

#include <stdexcept>
#include <string>

#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {

enum ExitCode : int {
  kExitOk = 0,
  kExitFailed = 1,          ///< any std::exception: a file, the data, or the solve
  kExitUsage = 2,           ///< unknown verb or option, or options that do not go together
  kExitNothingToTrack = 3,  ///< of `batch`: some clips show nobody, and none failed
  kExitInterrupted = 130,   ///< Ctrl-C or SIGTERM; what was being written is removed
};

/// Ends the command with one line on stderr and that code, where an action does not simply succeed or fail.
class CommandEnded : public std::runtime_error {
 public:
  CommandEnded(ExitCode code, const std::string& line) : std::runtime_error(line), code_(code) {}
  [[nodiscard]] ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// The words for --help.
constexpr const char* kExitCodeHelp =
    "Exit codes: 0 done, 1 failed (one line on stderr says why), 2 wrong usage, 130 interrupted.\n"
    "Output files are written whole or not at all.";

}  // namespace bodyloom
