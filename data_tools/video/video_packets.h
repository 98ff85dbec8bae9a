// SPDX-License-Identifier: Apache-2.0
/// Reads a video file's container: properties of its video stream, and its packets in decoding order.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "data_tools/video/libav_handles.h"

struct AVStream;

namespace bodyloom {

/// A camera, or a stream of a network.
struct LiveInput {
  std::string device;          ///< libavdevice's name of the kind of camera ("v4l2"); empty: a stream
  int width = 0, height = 0;   ///< asked of a camera; 0: its own choice
  double fps = 0;              ///< likewise
  std::function<bool()> stop;  ///< polled while waiting for the input, from this thread: true gives up
};

class VideoPackets {
 public:
  /// Opens the best video stream of a file. Throws std::runtime_error naming the path when it is missing, empty, not a
  /// video (text, sound alone, a cover image), or has frames of more than kMaxImagePixels.
  explicit VideoPackets(const std::string& path);
  /// Opens a camera or stream. A stream is read by network protocols alone, so that no playlist reaches for a file.
  /// Throws std::runtime_error naming the address, without a password that it may hold.
  VideoPackets(const std::string& address, const LiveInput& input);

  /// The next packet of the stream that holds data; false at the end. A truncated last packet is left out.
  bool Next(AVPacket* packet);

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const AVStream& stream() const;
  /// Frames per second: the nominal rate if the frames keep it, else the mean rate; 0 if unknown.
  [[nodiscard]] double fps() const;
  /// Width of a stored pixel divided by its height, by the container, else by the first frame; 1 if neither tells, or
  /// if they tell a ratio beyond 5, which no camera has, or within 0.5 % of 1, which is the rounding of a scaled size.
  [[nodiscard]] double PixelAspect(const AVFrame& first) const;
  /// VideoInfo::focal_35mm_mm, of the file or of its video stream.
  [[nodiscard]] double focal_35mm_mm() const;
  /// Number of displayed frames by the container; 0 if unknown.
  [[nodiscard]] int num_frames() const;
  /// After the end: evidence that the file is truncated ("its index promises 24 frames"); "" if there is none.
  [[nodiscard]] std::string CutOff() const;

 private:
  void NoteEnd(const AVPacket& packet);
  /// Finds the video stream of the opened input.
  void FindStream();

  std::string path_;
  std::unique_ptr<const std::function<bool()>> stop_;  ///< outlives the context, which polls it
  LibavPtr<AVFormatContext> context_;
  AVStream* stream_ = nullptr;
  int64_t promised_ = 0, delivered_ = 0;
  bool exact_promise_ = false, ends_within_a_packet_ = false;
  double promised_s_ = 0, end_s_ = 0;  ///< duration of the longest stream: by the container, by the packets
  std::string failure_;
};

}  // namespace bodyloom
