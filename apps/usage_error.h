// SPDX-License-Identifier: Apache-2.0
/// Error messages of the command line in one line, exit codes, and the main function shared by the programs.
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

/// The parser's message. For an unknown or missing verb, which the parser calls a missing subcommand, the message names
/// what was found instead and the verbs below the one that was given ("train: no verb "bogus", expected avatar, motion
/// or photo").
std::string UsageError(const CLI::App& app, const CLI::ParseError& error);

// Exit codes of the command, and the exceptions that lead to them.

enum ExitCode : int {
  kExitOk = 0,
  kExitFailed = 1,         ///< any std::exception: a file, the data, or the solve
  kExitUsage = 2,          ///< unknown verb or option, or options that do not go together
  kExitNoPersonFound = 3,  ///< with `batch`: some clips show nobody, and none failed
  kExitInterrupted = 130,  ///< Ctrl-C or SIGTERM; unfinished output is removed
};

/// Ends the command with one line on stderr and this exit code.
class CommandEnded : public std::runtime_error {
 public:
  CommandEnded(ExitCode code, const std::string& line) : std::runtime_error(line), code_(code) {}
  [[nodiscard]] ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// Text of the exit codes for --help.
constexpr const char* kExitCodeHelp =
    "Exit codes: 0 done, 1 failed (one line on stderr says why), 2 wrong usage, 130 interrupted.\n"
    "Output files are written whole or not at all.";

/// Help of an option that takes a body: `what` it is of, and what is taken without the option.
inline std::string BodyHelp(const std::string& what) {
  return what + " (default: the built-in body; hands: with fingers)";
}

// Main function of the programs installed beside `bodyloom`: parsing, running the action, and errors.

/// Parses the arguments, then runs the `action` set by their verb. `name`: the program's name for users, printed before
/// each error. Returns an exit code (apps/usage_error.h).
int RunParsed(CLI::App* app, const std::string& name, int argc, char** argv, const Action& action);

}  // namespace bodyloom
