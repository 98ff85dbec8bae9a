// SPDX-License-Identifier: Apache-2.0
/// Runs the real executable as a user would, and keeps what it said.
#pragma once

#include <filesystem>
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
  std::string interrupt_on;               ///< sends SIGINT once this text has appeared on stderr
  std::string work_folder;                ///< "": the caller's
};

/// Runs `bodyloom arguments...` with an empty stdin. Throws std::runtime_error when it cannot be started.
CommandResult RunCommand(const std::vector<std::string>& arguments, const CommandOptions& options = {});

/// A folder of its own for one test, removed at the end.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  [[nodiscard]] std::string path() const { return path_.string(); }
  /// Names of everything in it, hidden files included, sorted.
  [[nodiscard]] std::vector<std::string> Entries() const;

 private:
  std::filesystem::path path_;
};

}  // namespace bodyloom
