// SPDX-License-Identifier: Apache-2.0
/// Converts decoded frames to images: colours by the frame's colour space and range, with its display orientation.
#pragma once

#include <cstdint>
#include <string>

#include "data_tools/video/libav_handles.h"
#include "render/image/image.h"

namespace bodyloom {

// Display orientation: the display matrix of MP4 and MOV files (ISO/IEC 14496-12, 8.3.2: "tkhd"), of which phones use
// rotations by 90 degrees and reflections.

/// Transposition of the stored image, followed by reversal of its columns and of its rows.
struct DisplayOrientation {
  bool transpose = false, flip_columns = false, flip_rows = false;
  bool operator==(const DisplayOrientation&) const = default;
};

/// The orientation nearest to a matrix {a b u, c d v, x y w} by rows, which maps column p and row q of the stored image
/// to column a·p + c·q + x and row b·p + d·q + y of the displayed one. Null: as stored.
DisplayOrientation OrientationOf(const int32_t* matrix);

}  // namespace bodyloom

struct AVStream;

namespace bodyloom {

class FrameImage {
 public:
  /// `path` is for messages.
  FrameImage(const std::string& path, const AVStream& stream);

  /// Display size of a frame.
  [[nodiscard]] int WidthOf(const AVFrame& frame) const;
  [[nodiscard]] int HeightOf(const AVFrame& frame) const;

  /// Converts any depth and subsampling to eight bits, rounded to the nearest; chroma is interpolated from the frame's
  /// sample positions. Defaults are BT.601, limited range and chroma at the left (ffmpeg's convention). Transparency is
  /// left out; high dynamic range is not mapped. Throws std::runtime_error for a pixel format that cannot be converted.
  void Convert(const AVFrame& frame, Image* image);

 private:
  /// Parameters of a prepared conversion.
  struct Kind {
    int width = 0, height = 0, format = -1, colour_space = -1, chroma_location = -1;
    bool full_range = false;
    bool operator==(const Kind&) const = default;
  };
  void Prepare(const Kind& kind);

  std::string path_;
  DisplayOrientation orientation_;
  Kind kind_;
  LibavPtr<SwsContext> scaler_;
  LibavPtr<AVFrame> converted_;  ///< not oriented yet; rows are aligned for the converter
  Image as_stored_;              ///< the same with interleaved colours, if the image is to be transposed
};

}  // namespace bodyloom
