// SPDX-License-Identifier: Apache-2.0
/// The end of a program beside `bodyloom`: what its arguments ask for, done, and its errors as lines and exit codes.
#pragma once

#include <string>

#include "apps/verbs.h"

namespace bodyloom {

/// Parses the arguments, and runs what the verb that they name then has left in `action`. `name`: what a user calls the
/// program, before each error. Returns an exit code (apps/exit_code.h).
int RunParsed(CLI::App* app, const std::string& name, int argc, char** argv, const Action& action);

}  // namespace bodyloom
