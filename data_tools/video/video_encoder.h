// SPDX-License-Identifier: Apache-2.0
/// Images into the H.264 or MPEG-4 stream of an .mp4 file.
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

  /// The next frame, of the encoder's size. What cannot be written is noted for Finish().
  void Write(const Image& frame);
  /// Writes what was kept back and the file's index, and closes it; "" or why something could not be written.
  std::string Finish();
  /// "H.264" or "MPEG-4".
  [[nodiscard]] const std::string& codec() const;

 private:
  class Output;
  std::unique_ptr<Output> stream_;
};

}  // namespace bodyloom
