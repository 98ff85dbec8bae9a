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

/// Two orientations applied one after the other.
DisplayOrientation Then(const DisplayOrientation& first, const DisplayOrientation& second);

/// Clockwise turn by 0, 90, 180 or 270 degrees. Throws std::invalid_argument for another angle.
DisplayOrientation ClockwiseTurn(int degrees);

/// The image in that orientation.
Image Oriented(Image image, const DisplayOrientation& orientation);

/// The orientation nearest to a matrix {a b u, c d v, x y w} by rows, which maps column p and row q of the stored image
/// to column a·p + c·q + x and row b·p + d·q + y of the displayed one. Null: as stored.
DisplayOrientation OrientationOf(const int32_t* matrix);

}  // namespace bodyloom

struct AVStream;

namespace bodyloom {

struct FrameSize {
  int width = 0, height = 0;
  bool operator==(const FrameSize&) const = default;
};

class FrameImage {
 public:
  /// `path` is for messages. `pixel_aspect`: width of a stored pixel divided by its height, above 0; where it is not 1,
  /// the images have square pixels: the shorter side of the stored ones is enlarged (bilinear), so that no detail is
  /// lost. `turn_deg`: a further clockwise turn of the images as displayed.
  FrameImage(const std::string& path, const AVStream& stream, double pixel_aspect = 1, int turn_deg = 0);

  /// Size of a frame's image.
  [[nodiscard]] FrameSize SizeOf(const AVFrame& frame) const;
  /// The same before the pixels are made square: as programs see it that take stored pixels for square ones.
  [[nodiscard]] FrameSize StoredSizeOf(const AVFrame& frame) const;

  /// Converts any depth and subsampling to eight bits, rounded to the nearest; chroma is interpolated from the frame's
  /// sample positions. Defaults are BT.601, limited range and chroma at the left (ffmpeg's convention). Transparency is
  /// left out; high dynamic range is not mapped. Throws std::runtime_error for a pixel format that cannot be converted.
  void Convert(const AVFrame& frame, Image* image);

 private:
  /// Parameters of a prepared conversion.
  struct Kind {
    FrameSize size;
    int format = -1, colour_space = -1, chroma_location = -1;
    bool full_range = false;
    bool operator==(const Kind&) const = default;
  };
  void Prepare(const Kind& kind);
  /// Size with square pixels, not oriented.
  [[nodiscard]] FrameSize SquareSizeOf(const FrameSize& stored) const;
  [[nodiscard]] FrameSize Oriented(const FrameSize& size) const;

  std::string path_;
  double pixel_aspect_;
  DisplayOrientation orientation_;
  Kind kind_;
  LibavPtr<SwsContext> scaler_;
  LibavPtr<AVFrame> converted_;  ///< not oriented yet; rows are aligned for the converter
  Image as_stored_;              ///< the same with interleaved colours, if the image is to be transposed
};

}  // namespace bodyloom
