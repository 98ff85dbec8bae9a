// SPDX-License-Identifier: Apache-2.0
/// Runs the executable and captures its output.
#pragma once

#include <csignal>
#include <optional>
#include <string>
#include <vector>

namespace bodyloom {

struct CommandResult {
  int exit_code = -1;  ///< 128 + signal when a signal ended it
  std::string out, err;
  /// The number of lines on stderr.
  [[nodiscard]] int NumErrorLines() const;
};

struct CommandOptions {
  std::optional<size_t> file_size_limit;  ///< bytes a file may grow to (stands in for a full disk)
  std::string interrupt_on;               ///< sends the signal once this text has appeared on stderr
  int signal = SIGINT;
  std::string work_folder;  ///< "": the caller's
};

/// Runs `bodyloom arguments...` with an empty stdin. Throws std::runtime_error when it cannot be started.
CommandResult RunCommand(const std::vector<std::string>& arguments, const CommandOptions& options = {});

}  // namespace bodyloom
