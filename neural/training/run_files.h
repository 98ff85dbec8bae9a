// SPDX-License-Identifier: Apache-2.0
/// Files of a training run: atomic writing, and a log that a resumed run continues.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bodyloom {

/// Writes a temporary file (PATH.part): Commit() flushes it to the disk and renames it; without Commit() the destructor
/// removes it, and the file at `path` stays. Throws std::runtime_error "path: why".
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

/// metrics.csv: one line per report, the step in the first column. Every Add rewrites the whole file.
class MetricsLog {
 public:
  /// Creates a log with these columns after "step"; an existing file is replaced at the first Add.
  MetricsLog(std::string path, const std::vector<std::string>& columns);

  /// Keeps the lines of an existing file up to `step` (a resumed run writes later ones again); without a file the log
  /// is empty. Columns that a file of an earlier version lacks are left empty in its lines; throws std::runtime_error
  /// when it has others, or in another order.
  void KeepUpTo(int64_t step);

  /// Adds a line with values in the columns' order; NaN leaves a cell empty. Throws std::invalid_argument for another
  /// number of values.
  void Add(int64_t step, const std::vector<double>& values);

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string path_, header_, text_;
  size_t num_columns_;
};

}  // namespace bodyloom
