// SPDX-License-Identifier: Apache-2.0
/// Decoded frames as images: colours by the frame's own colour space and range, turned as they are shown.
#pragma once

#include <cstdint>
#include <string>

#include "data_tools/video/libav_handles.h"
#include "render/image/image.h"

namespace bodyloom {

// How a camera was held: the display matrix of MP4 and MOV files (ISO/IEC 14496-12, 8.3.2: "tkhd"), of which phones
// use the turns by 90 degrees and the mirror images.

/// First the stored picture is transposed, then its columns, then its rows are put into the opposite order.
struct DisplayOrientation {
  bool transpose = false, flip_columns = false, flip_rows = false;
  bool operator==(const DisplayOrientation&) const = default;
};

/// The orientation nearest to a matrix {a b u, c d v, x y w} by rows, which takes column p and row q of the stored
/// picture to column a·p + c·q + x and row b·p + d·q + y of the shown one. Null: as stored.
DisplayOrientation OrientationOf(const int32_t* matrix);

}  // namespace bodyloom

struct AVStream;

namespace bodyloom {

class FrameImage {
 public:
  /// `path` is for messages.
  FrameImage(const std::string& path, const AVStream& stream);

  /// The size that a frame is shown in.
  [[nodiscard]] int WidthOf(const AVFrame& frame) const;
  [[nodiscard]] int HeightOf(const AVFrame& frame) const;

  /// Any depth and subsampling to eight bits, rounded to the nearest; chroma is interpolated from where the frame says
  /// it was sampled. BT.601, limited range and chroma at the left where the frame does not say (ffmpeg's convention).
  /// Transparency is left out; high dynamic range is not mapped. Throws std::runtime_error for a pixel format that
  /// cannot be converted.
  void Convert(const AVFrame& frame, Image* image);

 private:
  /// What a conversion was prepared for.
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
  LibavPtr<AVFrame> converted_;  ///< not turned yet; rows are aligned as the converter likes them
  Image as_stored_;              ///< the same with the colours side by side, where the picture is to be transposed
};

}  // namespace bodyloom
