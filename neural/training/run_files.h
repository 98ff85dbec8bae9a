// SPDX-License-Identifier: Apache-2.0
/// Files of a training run: written whole or not at all, and a log that a resumed run continues.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bodyloom {

/// A file written piece by piece beside its place (PATH.part): Commit() flushes it to the disk and renames; without it
/// the destructor removes it, and what stood at `path` stays. Throws std::runtime_error "path: why".
class RunFile {
 public:
  explicit RunFile(std::string path);
  ~RunFile();
  RunFile(const RunFile&) = delete;
  RunFile& operator=(const RunFile&) = delete;
  void Write(const void* bytes, size_t size);
  void Commit();

 private:
  [[noreturn]] void Fail(const char* what) const;
  std::string path_, part_;
  int descriptor_ = -1;
};

void WriteRunText(const std::string& path, const std::string& text);

/// metrics.csv: a line a report, the step in the first column. The file is rewritten whole by every Add.
class MetricsLog {
 public:
  /// A new log with these columns behind "step"; an existing file is replaced at the first Add.
  MetricsLog(std::string path, const std::vector<std::string>& columns);

  /// Keeps the lines of an existing file up to `step` (a run that goes on from a checkpoint writes later ones again);
  /// no file is an empty log. Columns that the file lacks, as one of an earlier version may, are left empty in its
  /// lines; throws std::runtime_error when it has others, or in another order.
  void KeepUpTo(int64_t step);

  /// Values in the columns' order; NaN leaves a cell empty. Throws std::invalid_argument for another number of values.
  void Add(int64_t step, const std::vector<double>& values);

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string path_, header_, text_;
  size_t num_columns_;
};

}  // namespace bodyloom
