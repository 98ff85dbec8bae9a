// SPDX-License-Identifier: Apache-2.0
/// Writes an .mp4: H.264 (constant rate factor 23) where the installed ffmpeg has libx264, MPEG-4 (quantiser 3)
/// otherwise; colours by BT.601 in limited range, as stated in the file. The file appears at its path atomically when
/// Finish() returns.
#pragma once

#include <memory>
#include <string>

#include "render/image/image.h"

namespace bodyloom {

class VideoWriter {
 public:
  /// Frames of width×height pixels; an odd side is made even by repeating its last row or column, as players expect.
  /// Throws std::runtime_error naming the path when its extension is not .mp4, its folder does not exist or cannot be
  /// written, or there is no encoder; std::invalid_argument for a side below 2 or above 16384, for 2^26 pixels or more
  /// (a reader would refuse them), and for a frame rate outside (0, 1000].
  VideoWriter(const std::string& path, int width, int height, double fps);
  /// Discards everything written if Finish() was not called.
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// Throws std::invalid_argument when the frame has another size.
  void Write(const Image& frame);

  /// Closes the file, reads it back and moves it into place. Throws std::runtime_error naming the path when it holds
  /// fewer frames than were written, or none were.
  void Finish();

  [[nodiscard]] int num_frames() const;
  /// "H.264" or "MPEG-4".
  [[nodiscard]] std::string codec() const;

 private:
  class Sink;
  std::unique_ptr<Sink> sink_;
};

}  // namespace bodyloom
