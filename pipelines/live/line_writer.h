// SPDX-License-Identifier: Apache-2.0
/// Writes lines to a file or to standard output from a thread of its own, so that a slow reader holds up nobody.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <string>
#include <thread>

#include "geometry/base/mailbox.h"

namespace bodyloom {

class LineWriter {
 public:
  /// `path`: a file, which is emptied and grows line by line, or "-": standard output. At most 256 lines wait; a reader
  /// that is slower loses the oldest ones, or is waited for. Throws std::runtime_error naming a file that cannot be
  /// written.
  LineWriter(const std::string& path, WhenFull when_full);
  /// Writes what waits, but gives up a reader that takes nothing for a second.
  ~LineWriter();
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;

  /// Adds a line, without its line break. Returns false once writing has failed.
  bool Write(std::string line);
  /// Ends it as the destructor does; throws std::runtime_error naming the file when writing failed.
  void Finish();
  [[nodiscard]] int64_t num_dropped() const { return lines_.num_dropped(); }

 private:
  void Run();
  void WriteAll(const std::string& text);
  void Join();

  std::string path_;
  int file_ = -1;
  bool closes_file_ = false;
  std::atomic<bool> ending_ = false;
  Mailbox<std::string> lines_;
  std::exception_ptr error_;
  std::thread thread_;  ///< last: it uses all of the above
};

}  // namespace bodyloom
