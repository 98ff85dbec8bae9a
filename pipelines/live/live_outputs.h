// SPDX-License-Identifier: Apache-2.0
/// The outputs of live tracking: a web page, VMC over UDP, JSON lines, and the caller's function.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "geometry/base/mailbox.h"
#include "pipelines/live/live_state.h"

namespace bodyloom {

struct LiveOutputsRequest {
  std::string page_address, page_title;  ///< ADDRESS:PORT (live_server.h); empty: no page
  std::string vmc_address;               ///< HOST:PORT (vmc_sender.h); empty: nowhere
  std::string jsonl;                     ///< file for LiveJson() of every frame, "-": standard output; empty: none
  std::function<void(const LiveState&)> on_frame;
};

/// VMC has its origin on the ground where the person was first.
class LiveOutputs {
 public:
  /// `when_full`: what becomes of lines that nobody takes in time. Throws std::runtime_error naming an address or file
  /// that cannot be used.
  LiveOutputs(const LiveOutputsRequest& request, WhenFull when_full);
  ~LiveOutputs();
  LiveOutputs(const LiveOutputs&) = delete;
  LiveOutputs& operator=(const LiveOutputs&) = delete;

  /// Returns false when nobody takes the lines any more.
  bool Send(const LiveState& state);
  /// Of the page; "" without one.
  [[nodiscard]] std::string url() const;
  /// Writes the lines that wait; returns the number of those that nobody took.
  int64_t Finish();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Writes lines to a file or to standard output from a thread of its own, so that a slow reader holds up nobody.
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
