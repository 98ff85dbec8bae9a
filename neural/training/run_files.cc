// SPDX-License-Identifier: Apache-2.0
#include "neural/training/run_files.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {

RunFile::RunFile(std::string path) : path_(std::move(path)), part_(path_ + ".part") {
  descriptor_ = open(part_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) Fail("cannot be written");
}

RunFile::~RunFile() {
  if (descriptor_ >= 0) {
    close(descriptor_);
    unlink(part_.c_str());
  }
}

void RunFile::Fail(const char* what) const {
  throw std::runtime_error(path_ + ": " + what + ": " + std::strerror(errno));
}

void RunFile::Write(const void* bytes, size_t size) {
  const char* next = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t written = write(descriptor_, next, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) Fail("cannot be written");
    next += written;
    size -= static_cast<size_t>(written);
  }
}

void RunFile::Commit() {
  if (fsync(descriptor_) != 0) Fail("cannot be written");
  const int closed = close(std::exchange(descriptor_, -1));
  if (closed != 0 || rename(part_.c_str(), path_.c_str()) != 0) {
    const int error = errno;
    unlink(part_.c_str());
    errno = error;
    Fail("cannot be written");
  }
  // Flushes the folder, so that the renaming is on the disk.
  const std::string folder = std::filesystem::path(path_).parent_path().string();
  const int folder_descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_descriptor >= 0) {
    fsync(folder_descriptor);
    close(folder_descriptor);
  }
}

void WriteRunText(const std::string& path, const std::string& text) {
  RunFile file(path);
  file.Write(text.data(), text.size());
  file.Commit();
}

namespace {

std::vector<std::string> Cells(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

}  // namespace

MetricsLog::MetricsLog(std::string path, const std::vector<std::string>& columns)
    : path_(std::move(path)), header_("step"), num_columns_(columns.size()) {
  for (const std::string& column : columns) header_ += "," + column;
  text_ = header_ + "\n";
}

void MetricsLog::KeepUpTo(int64_t step) {
  text_ = header_ + "\n";
  std::ifstream file(path_);
  std::string line;
  if (!std::getline(file, line)) return;
  // Index in the file's lines for each column of this log; none: not written by an earlier version.
  const std::vector<std::string> columns = Cells(header_), theirs = Cells(line);
  std::vector<std::optional<size_t>> place(columns.size());
  size_t found = 0;
  for (size_t i = 0; i < columns.size(); ++i) {
    if (found < theirs.size() && columns[i] == theirs[found]) place[i] = found++;
  }
  if (found != theirs.size() || !place[0]) {
    throw std::runtime_error(path_ + ": line 1: columns \"" + line + "\", expected \"" + header_ + "\"");
  }
  while (std::getline(file, line)) {
    if (std::atoll(line.c_str()) > step) continue;
    const std::vector<std::string> cells = Cells(line);
    for (size_t i = 0; i < columns.size(); ++i) {
      text_ += (i > 0 ? "," : "") + (place[i] && *place[i] < cells.size() ? cells[*place[i]] : std::string());
    }
    text_ += "\n";
  }
}

void MetricsLog::Add(int64_t step, const std::vector<double>& values) {
  BODYLOOM_CHECK(values.size() == num_columns_, "metrics log: ", values.size(), " values for ", num_columns_,
                 " columns");
  std::ostringstream line;
  line.precision(6);
  line << step;
  for (const double value : values) {
    line << ',';
    if (!std::isnan(value)) line << value;
  }
  text_ += line.str() + "\n";
  WriteRunText(path_, text_);
}

}  // namespace bodyloom
