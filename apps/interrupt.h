// SPDX-License-Identifier: Apache-2.0
/// Ctrl-C without half files: the first SIGINT or SIGTERM raises a flag that long work polls, the second one kills.
#pragma once

namespace bodyloom {

/// Installs the handlers, and ignores SIGPIPE and SIGXFSZ so that a closed pipe or a file-size limit becomes a write
/// error with a message instead of a silent death.
void InstallSignalHandlers();

[[nodiscard]] bool IsInterrupted();

}  // namespace bodyloom
