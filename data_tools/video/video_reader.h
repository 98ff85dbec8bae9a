// SPDX-License-Identifier: Apache-2.0
/// Frames of a video file, or of a folder of images, one after the other; a still image is a folder of one.
#pragma once

#include <memory>
#include <string>

#include "render/image/image.h"

namespace bodyloom {

struct VideoInfo {
  int width = 0, height = 0;  ///< of the frames as they are shown (after the display matrix that a phone has noted)
  /// Frames a second: the nominal rate, or the mean where the rate varies; 0: the file does not say (always so for a
  /// folder of images).
  double fps = 0;
  /// Focal length of the same diagonal angle of view on film of 36 mm × 24 mm, as the camera noted it in the (first)
  /// picture's Exif or in a QuickTime file; 0: it did not. A video that was steadied shows less than that.
  double focal_35mm_mm = 0;
  int num_frames = 0;  ///< as the container says, 0 when it does not (.mkv, .webm, .ts); exact for a folder
};

class VideoReader {
 public:
  /// Opens a video file that ffmpeg decodes, a folder of images (in the order of ImageFilesOf), or a still image.
  /// Throws std::runtime_error naming the path when it is missing, empty, no video, its frames have more than 2^26
  /// pixels, or its first frame cannot be decoded.
  explicit VideoReader(const std::string& path);
  ~VideoReader();
  VideoReader(const VideoReader&) = delete;
  VideoReader& operator=(const VideoReader&) = delete;

  [[nodiscard]] const VideoInfo& info() const;

  /// The next frame as it is shown, in eight bits: turned by its display matrix, colours by the file's colour space and
  /// range (BT.601, limited, where it does not say). False at the end; of a file that is cut off that is after its last
  /// whole frame, and frames that cannot be decoded are passed over: see warning(). Throws std::runtime_error naming
  /// path and frame when a frame has another size than the first.
  bool Read(Image* frame);

  /// Passes over up to `count` frames without converting them; returns how many there were.
  int Skip(int count);

  /// Passes over the frames that are shown before `seconds` on the clock of frame_time(), so that Read returns the
  /// first one at or after it (to a microsecond); returns how many there were. Throws std::runtime_error for a folder,
  /// which has no clock.
  int SkipTo(double seconds);

  /// Index of the frame that Read returns next.
  [[nodiscard]] int next_frame() const;

  /// When the frame that was read or passed over last is shown: seconds after the first frame, by the presentation
  /// timestamps; each later than the one before. 0 before the first frame; NaN for a folder of images.
  [[nodiscard]] double frame_time() const;

  /// What was wrong with the file so far and did not stop the reading, one line that names the path: frames that could
  /// not be decoded, or whose parts are damaged; and after the end, that the file is cut off. Empty when nothing was.
  [[nodiscard]] std::string warning() const;

 private:
  class Source;
  class FileSource;
  class ImagesSource;
  std::unique_ptr<Source> source_;
};

}  // namespace bodyloom
