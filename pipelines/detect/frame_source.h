// SPDX-License-Identifier: Apache-2.0
/// The frames of a span of a video, one after the other, each with the second at which it is shown.
#pragma once

#include <string>

#include "bodyloom/data_tools/video/video_reader.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

struct FrameSpan {
  double fps = 0;                ///< of a folder of images, or a video that does not say; 0: 30
  double from_s = 0, to_s = -1;  ///< seconds from the first frame, both included; to_s < 0: to the end
};

class FrameSource {
 public:
  /// Throws RequestError for a span that holds no frame, std::runtime_error naming a video that cannot be read.
  FrameSource(const std::string& video, const FrameSpan& span);

  [[nodiscard]] const VideoInfo& info() const { return reader_.info(); }
  /// About how many frames there are; 0 when the video does not say how long it is.
  [[nodiscard]] int num_frames() const;
  /// Frames a second: the video's, else the span's, else 30.
  [[nodiscard]] double fps() const { return fps_; }
  /// False at the end. Another thread may read than made the source, one at a time.
  bool Read(Image* frame, double* time_s);
  /// What was wrong with the video; not while another thread reads.
  [[nodiscard]] std::string warning() const { return reader_.warning(); }

 private:
  VideoReader reader_;
  bool has_clock_;  ///< a folder of images has none
  bool at_end_ = false;
  double to_s_, fps_;
  int first_ = 0;
};

}  // namespace bodyloom
