// SPDX-License-Identifier: Apache-2.0
/// Frames of a video file, or of a folder of images, one after the other.
#pragma once

#include <memory>
#include <string>

#include "bodyloom/render/image.h"

namespace bodyloom {

struct VideoInfo {
  int width = 0, height = 0;  ///< of the decoded frames (after the rotation a phone may have noted)
  double fps = 0;             ///< 0: the file does not say (always so for a folder of images)
  int num_frames = 0;         ///< as the container says, 0 when it does not; exact for a folder
};

class VideoReader {
 public:
  /// Opens a video file that ffmpeg decodes, or a folder of images (in the order of ImageFilesOf). Throws
  /// std::runtime_error naming the path when it is missing, empty, no video, or its first frame cannot be decoded.
  explicit VideoReader(const std::string& path);
  ~VideoReader();
  VideoReader(const VideoReader&) = delete;
  VideoReader& operator=(const VideoReader&) = delete;

  [[nodiscard]] const VideoInfo& info() const;

  /// The next frame; false at the end. Throws std::runtime_error naming path and frame when a frame has another size
  /// than the first, or when the file ends more than a tenth before the number of frames it promises.
  bool Read(Image* frame);

  /// Passes over up to `count` frames; returns how many there were. Throws as Read.
  int Skip(int count);

  /// Index of the frame that Read returns next.
  [[nodiscard]] int next_frame() const;

 private:
  class Source;
  std::unique_ptr<Source> source_;
};

}  // namespace bodyloom
