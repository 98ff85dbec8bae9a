// SPDX-License-Identifier: Apache-2.0
#include "pipelines/live/line_writer.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>

namespace bodyloom {
namespace {

constexpr size_t kWaitingLines = 256;
constexpr int kPatience_ms = 1000;  ///< with a reader, at the end

[[noreturn]] void ThrowWriteFailed(const std::string& path) {
  const std::string what = path == "-" ? "standard output" : path;
  throw std::runtime_error(what + ": writing failed (" + std::strerror(errno) + ")");
}

}  // namespace

LineWriter::LineWriter(const std::string& path, WhenFull when_full)
    : path_(path), file_(STDOUT_FILENO), closes_file_(path != "-"), lines_(kWaitingLines, when_full) {
  if (closes_file_) file_ = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file_ < 0) ThrowWriteFailed(path);
  thread_ = std::thread([this] { Run(); });
}

LineWriter::~LineWriter() { Join(); }

void LineWriter::Join() {
  if (!thread_.joinable()) return;
  ending_ = true;
  lines_.Close();
  thread_.join();
  if (closes_file_) close(file_);
}

bool LineWriter::Write(std::string line) { return lines_.Put(std::move(line)); }

void LineWriter::Finish() {
  Join();
  if (error_) std::rethrow_exception(error_);
}

void LineWriter::Run() {
  try {
    while (std::optional<std::string> line = lines_.Take()) WriteAll(*line + "\n");
  } catch (...) {
    error_ = std::current_exception();
    lines_.Close();
  }
}

void LineWriter::WriteAll(const std::string& text) {
  for (size_t written = 0; written < text.size();) {
    pollfd ready = {file_, POLLOUT, 0};
    const int found = poll(&ready, 1, kPatience_ms);
    if (found == 0 && ending_) {
      lines_.Close();
      while (lines_.Take()) continue;
      return;
    }
    if (found <= 0) continue;
    // A pipe that is ready takes this many bytes without blocking.
    const ssize_t count = write(file_, text.data() + written, std::min<size_t>(text.size() - written, PIPE_BUF));
    if (count < 0 && errno != EINTR && errno != EAGAIN) ThrowWriteFailed(path_);
    written += size_t(std::max<ssize_t>(count, 0));
  }
}

}  // namespace bodyloom
