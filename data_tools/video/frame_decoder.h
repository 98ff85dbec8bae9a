// SPDX-License-Identifier: Apache-2.0
/// The decoded frames of a video file in the order in which they are shown, and when.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "data_tools/video/libav_handles.h"
#include "data_tools/video/video_packets.h"

namespace bodyloom {

// Seconds from the presentation timestamps of frames, in the order in which they are shown.

class FrameClock {
 public:
  /// A tick is numerator / denominator seconds (the stream's time base). `frame_s`: the usual time between two frames,
  /// more than 0.
  FrameClock(int numerator, int denominator, double frame_s);

  /// Seconds since the first frame, each more than the one before. What files leave out or get wrong is filled in: a
  /// frame without a timestamp comes `frame_s` after the one before, one that is not later half of `frame_s`; and where
  /// the timestamps go back by more than a second (recordings put one behind the other), the clock goes on.
  double Next(std::optional<int64_t> timestamp);

 private:
  double tick_numerator_, tick_denominator_, frame_s_;
  std::optional<int64_t> origin_;
  double shift_s_ = 0, last_s_ = 0;
  bool has_last_ = false;
};

/// Several frames are decoded at once, on as many threads as there are processors.
class FrameDecoder {
 public:
  /// Throws as VideoPackets, and when no decoder is there.
  explicit FrameDecoder(const std::string& path);

  /// Decodes the next frame that can be; false at the end.
  bool Next();
  /// The frame decoded last; its pixels are as the codec stores them.
  [[nodiscard]] const AVFrame& frame() const { return *frame_; }
  /// When it is shown, seconds after the first frame.
  [[nodiscard]] double time() const { return time_s_; }
  /// How many frames could not be decoded so far, and how many of those that were have damaged parts.
  [[nodiscard]] int num_lost() const { return lost_; }
  [[nodiscard]] int num_damaged() const { return damaged_; }
  [[nodiscard]] const VideoPackets& packets() const { return packets_; }

 private:
  bool Feed();

  VideoPackets packets_;
  LibavPtr<AVCodecContext> codec_;
  LibavPtr<AVFrame> frame_;
  LibavPtr<AVPacket> packet_;
  FrameClock clock_;
  double time_s_ = 0;
  int lost_ = 0, damaged_ = 0;
  bool draining_ = false;
};

/// The clock of a stream's frames.
FrameClock ClockOf(const VideoPackets& packets);

}  // namespace bodyloom
