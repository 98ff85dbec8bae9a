// SPDX-License-Identifier: Apache-2.0
/// Reads the frames of a video file or a folder of images in order; a still image is treated as a folder of one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/image/image.h"

namespace bodyloom {

struct VideoInfo {
  /// Of the frames as displayed: square pixels, after the display matrix of phones and the reader's turn.
  int width = 0, height = 0;
  /// The same before the pixels of anamorphic video are made square. Programs that take stored pixels for square ones
  /// (OpenCV's VideoCapture and most detectors) see frames of this size.
  int stored_width = 0, stored_height = 0;
  /// Frames per second: the nominal rate, or the mean if the rate varies; 0: unknown (always for a folder of images).
  double fps = 0;
  /// Focal length of the same diagonal angle of view on film of 36 mm × 24 mm, from the Exif of the (first) image or
  /// from a QuickTime file; 0: unknown. A stabilised video has a smaller angle of view.
  double focal_35mm_mm = 0;
  int num_frames = 0;  ///< by the container, 0 if unknown (.mkv, .webm, .ts); exact for a folder
  [[nodiscard]] bool IsAnamorphic() const { return width != stored_width || height != stored_height; }
};

class VideoReader {
 public:
  /// Opens a video file that ffmpeg decodes, a folder of images (in the order of ImageFilesOf), or a still image.
  /// Throws std::runtime_error naming the path when it is missing, empty, not a video, its frames have more than 2^26
  /// pixels, or its first frame cannot be decoded. `turn_deg`: frames and images are turned clockwise by 0, 90, 180 or
  /// 270 degrees; throws std::invalid_argument for another angle.
  explicit VideoReader(const std::string& path, int turn_deg = 0);
  ~VideoReader();
  VideoReader(const VideoReader&) = delete;
  VideoReader& operator=(const VideoReader&) = delete;

  [[nodiscard]] const VideoInfo& info() const;

  /// Reads the next frame as displayed, in eight bits: oriented by its display matrix, with square pixels, interlaced
  /// ones as whole pictures (Deinterlacer), colours by the file's colour space and range (default BT.601, limited).
  /// False at the end, which in a truncated file is after its last whole frame; frames that cannot be decoded are
  /// skipped: see warning(). Throws std::runtime_error naming path and frame when a frame has another size than the
  /// first.
  bool Read(Image* frame);

  /// Skips up to `count` frames without converting them; returns the number skipped.
  int Skip(int count);

  /// Skips the frames with a frame_time() before `seconds`, so that Read returns the first one at or after it (to a
  /// microsecond); returns the number skipped. Throws std::runtime_error for a folder, which has no timestamps.
  int SkipTo(double seconds);

  /// Index of the frame that Read returns next.
  [[nodiscard]] int next_frame() const;

  /// Presentation time of the frame last read or skipped: seconds after the first frame, by the presentation
  /// timestamps, strictly increasing. 0 before the first frame; NaN for a folder of images.
  [[nodiscard]] double frame_time() const;

  /// Non-fatal faults of the file so far, one line that names the path: frames that could not be decoded or have
  /// damaged parts, and after the end, a truncated file. Empty if there were none.
  [[nodiscard]] std::string warning() const;

  /// Changes that were made to the frames so far beyond the file's display matrix, one line that names the path:
  /// interlaced frames, pixels that are not square. Empty if there were none.
  [[nodiscard]] std::string note() const;

 private:
  class Source;
  class FileSource;
  class ImagesSource;
  std::unique_ptr<Source> source_;
};

/// Presentation times of a video's frames, without decoding them where possible.
/// Returns VideoReader::frame_time() of every frame of a file: seconds after the first frame, increasing. They come
/// from the timestamps of the file's packets alone (a minute of video takes milliseconds); where these are
/// insufficient, the frames are decoded (streams without timestamps, interlaced ones, hidden frames of VP8,
/// concatenated recordings, beginnings that cannot be decoded). Undecodable frames of a damaged file are included.
/// Empty for images, which have no timestamps. Throws as VideoReader.
std::vector<double> VideoFrameTimes(const std::string& path);

}  // namespace bodyloom
