// SPDX-License-Identifier: Apache-2.0
/// Exit codes of the command: those that scripts may rely on, and the exceptions that lead to them.
#pragma once

#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {

enum ExitCode : int {
  kExitOk = 0,
  kExitFailed = 1,         ///< any std::exception: a file, the data, or the solve
  kExitUsage = 2,          ///< unknown verb or option, or options that do not go together
  kExitInterrupted = 130,  ///< Ctrl-C or SIGTERM; what was being written is removed
};

/// The words for --help.
constexpr const char* kExitCodeHelp =
    "Exit codes: 0 done, 1 failed (one line on stderr says why), 2 wrong usage, 130 interrupted.\n"
    "Output files are written whole or not at all.";

}  // namespace bodyloom
