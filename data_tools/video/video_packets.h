// SPDX-License-Identifier: Apache-2.0
/// A video file's container: what it says of its pictures, and their packets in the order of decoding.
#pragma once

#include <cstdint>
#include <string>

#include "data_tools/video/libav_handles.h"

struct AVStream;

namespace bodyloom {

class VideoPackets {
 public:
  /// Opens the best video stream of a file. Throws std::runtime_error naming the path when it is missing, empty, no
  /// video (text, sound alone, a cover picture), or promises pictures of more than kMaxPicturePixels.
  explicit VideoPackets(const std::string& path);

  /// The next packet of the stream that holds data; false at the end. A last packet that the file cuts off is left out.
  bool Next(AVPacket* packet);

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const AVStream& stream() const;
  /// Frames a second: the nominal rate where the frames keep it, else the mean rate; 0 when the file does not say.
  [[nodiscard]] double fps() const;
  /// VideoInfo::focal_35mm_mm, of the file or of its picture stream.
  [[nodiscard]] double focal_35mm_mm() const;
  /// Frames to be shown, as the container says; 0 when it does not.
  [[nodiscard]] int num_frames() const;
  /// After the end: what shows that the file should have gone on ("its index promises 24 frames"); "" when nothing
  /// does.
  [[nodiscard]] std::string CutOff() const;

 private:
  void NoteEnd(const AVPacket& packet);

  std::string path_;
  LibavPtr<AVFormatContext> context_;
  AVStream* stream_ = nullptr;
  int64_t promised_ = 0, delivered_ = 0;
  bool exact_promise_ = false, ends_within_a_packet_ = false;
  double promised_s_ = 0, end_s_ = 0;  ///< of the longest stream: as the container says, as the packets reached
  std::string failure_;
};

}  // namespace bodyloom
