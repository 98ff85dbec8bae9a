// SPDX-License-Identifier: Apache-2.0
/// Makes whole pictures of interlaced frames, whose odd and even rows were taken at two times.
#pragma once

#include <cstdint>
#include <string>

#include "data_tools/video/libav_handles.h"

struct AVFilterContext;

namespace bodyloom {

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

}  // namespace bodyloom
