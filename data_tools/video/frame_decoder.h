// SPDX-License-Identifier: Apache-2.0
/// Decodes the frames of a video file in presentation order, with their times.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "data_tools/video/libav_handles.h"
#include "data_tools/video/video_packets.h"

struct AVFilterContext;

namespace bodyloom {

/// Makes whole pictures of interlaced frames, whose odd and even rows were taken at two times.
/// ffmpeg's filter bwdif (an edge-directed interpolation of the second field's rows, w3fdif's where they move): one
/// picture per frame, at the time of its first field. Frames that are not marked as interlaced pass as they are.
class Deinterlacer {
 public:
  /// For frames like the first one. `path` is for messages. Throws std::runtime_error when the filter cannot be made.
  Deinterlacer(const std::string& path, const AVFrame& first);

  /// Takes the next frame, whose pixels are referenced; null: the end. Throws std::runtime_error for a frame of another
  /// size or pixel format.
  void Push(AVFrame* frame);
  /// The next picture, one for each frame in order; false if it waits for a frame, or after the last.
  bool Pull(AVFrame* picture);

 private:
  std::string path_;
  LibavPtr<AVFilterGraph> graph_;
  AVFilterContext *source_ = nullptr, *sink_ = nullptr;
  int64_t num_frames_ = 0;
};

// Times in seconds from the presentation timestamps of frames, in presentation order.

class FrameClock {
 public:
  /// A tick is numerator / denominator seconds (the stream's time base). `frame_s`: the usual time between two frames,
  /// more than 0.
  FrameClock(int numerator, int denominator, double frame_s);

  /// Returns seconds since the first frame, strictly increasing. Missing or wrong timestamps are replaced: a frame
  /// without one comes `frame_s` after its predecessor, one that is not later half of `frame_s`; where timestamps go
  /// back by more than a second (concatenated recordings), the clock continues.
  double Next(std::optional<int64_t> timestamp);

 private:
  double tick_numerator_, tick_denominator_, frame_s_;
  std::optional<int64_t> origin_;
  double shift_s_ = 0, last_s_ = 0;
  bool has_last_ = false;
};

/// Several frames are decoded at once, on as many threads as there are processors; with `low_delay` one after the
/// other, so that each comes as soon as its packets are there. Interlaced frames become whole pictures (Deinterlacer).
class FrameDecoder {
 public:
  /// Throws as VideoPackets, and when there is no decoder.
  explicit FrameDecoder(const std::string& path);
  FrameDecoder(VideoPackets packets, bool low_delay);

  /// Decodes the next decodable frame; false at the end.
  bool Next();
  /// The frame decoded last; its pixels are as the codec stores them, of an interlaced one those of its first field.
  [[nodiscard]] const AVFrame& frame() const { return *frame_; }
  /// Presentation time of that frame, seconds after the first one.
  [[nodiscard]] double time() const { return time_s_; }
  /// The moment at which the last packet was there, before it was decoded.
  [[nodiscard]] std::chrono::steady_clock::time_point packet_arrived() const { return packet_arrived_; }
  /// Number of frames so far that could not be decoded, and of decoded ones with damaged parts.
  [[nodiscard]] int num_lost() const { return lost_; }
  [[nodiscard]] int num_damaged() const { return damaged_; }
  /// Returns true if there was an interlaced frame so far.
  [[nodiscard]] bool is_interlaced() const { return deinterlacer_.has_value(); }
  [[nodiscard]] const VideoPackets& packets() const { return packets_; }

 private:
  bool Feed();
  /// Decodes the next frame as stored, and its time; false at the end.
  bool Decode();

  VideoPackets packets_;
  LibavPtr<AVCodecContext> codec_;
  LibavPtr<AVFrame> frame_;
  LibavPtr<AVPacket> packet_;
  FrameClock clock_;
  std::optional<Deinterlacer> deinterlacer_;
  std::deque<double> times_in_deinterlacer_;
  double time_s_ = 0;
  std::chrono::steady_clock::time_point packet_arrived_;
  int lost_ = 0, damaged_ = 0;
  bool draining_ = false, deinterlacer_draining_ = false;
};

/// The clock of a stream's frames.
FrameClock ClockOf(const VideoPackets& packets);

}  // namespace bodyloom
