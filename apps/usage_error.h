// SPDX-License-Identifier: Apache-2.0
/// What was wrong with a command line, in one line.
#pragma once

#include <stdexcept>
#include <string>

#include "apps/verbs.h"
#include "geometry/base/callbacks.h"

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace bodyloom {

/// The parser's own words, but for a verb that is unknown or missing, which it calls a missing subcommand: then what
/// was found in its place, and which verbs there are below the one that was given ("train: no verb "bogus", expected
/// avatar, motion or photo").
std::string UsageError(const CLI::App& app, const CLI::ParseError& error);

// Exit codes of the command: those that scripts may rely on, and the exceptions that lead to them.

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

// The end of a program beside `bodyloom`: what its arguments ask for, done, and its errors as lines and exit codes.

/// Parses the arguments, and runs what the verb that they name then has left in `action`. `name`: what a user calls the
/// program, before each error. Returns an exit code (apps/usage_error.h).
int RunParsed(CLI::App* app, const std::string& name, int argc, char** argv, const Action& action);

}  // namespace bodyloom
