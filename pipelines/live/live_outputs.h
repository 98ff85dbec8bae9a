// SPDX-License-Identifier: Apache-2.0
/// The outputs of live tracking: a web page, VMC over UDP, JSON lines, and the caller's function.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

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

}  // namespace bodyloom
