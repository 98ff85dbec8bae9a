// SPDX-License-Identifier: Apache-2.0
/// Encodes images to the H.264 or MPEG-4 stream of an .mp4 file.
#pragma once

#include <memory>
#include <string>

#include "render/image/image.h"

namespace bodyloom {

class VideoEncoder {
 public:
  /// `file` is written, `path` is named in messages. Sides from 2; an odd one is made even by repeating its last row or
  /// column. `fps` is kept to the nearest fraction of numbers below 2^16. Throws std::runtime_error when the file
  /// cannot be opened or there is no encoder.
  VideoEncoder(const std::string& file, const std::string& path, int width, int height, double fps);
  ~VideoEncoder();
  VideoEncoder(const VideoEncoder&) = delete;
  VideoEncoder& operator=(const VideoEncoder&) = delete;

  /// Writes the next frame, of the encoder's size. Errors are kept for Finish().
  void Write(const Image& frame);
  /// Writes delayed frames and the file's index, and closes it; returns "" or the reason of an error.
  std::string Finish();
  /// "H.264" or "MPEG-4".
  [[nodiscard]] const std::string& codec() const;

 private:
  class Output;
  std::unique_ptr<Output> stream_;
};

}  // namespace bodyloom
