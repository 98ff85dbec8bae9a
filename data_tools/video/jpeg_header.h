// SPDX-License-Identifier: Apache-2.0
/// The header of a JPEG, read before the file is decoded.
#pragma once

#include <optional>
#include <string_view>

namespace bodyloom {

struct JpegHeader {
  int width = 0, height = 0;  ///< 0: no frame header was found
  int components = 3;         ///< 1 grey, 3 colours, 4 inks
  double focal_35mm_mm = 0;   ///< of its Exif (exif.h); 0: it has none
  bool ends = false;          ///< an end-of-image marker comes after the first scan began
};

/// Of a file's bytes; nullopt when they are no JPEG. Source: ITU-T T.81, Annex B.
std::optional<JpegHeader> ReadJpegHeader(std::string_view bytes);

}  // namespace bodyloom
