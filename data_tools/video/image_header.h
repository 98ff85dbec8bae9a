// SPDX-License-Identifier: Apache-2.0
/// Reads the size in an image file's header, so that a file that claims a billion pixels is refused before a decoder
/// allocates memory for them.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace bodyloom {

struct ImageHeader {
  int64_t width = 0, height = 0;  ///< pixels as stored, 1 to 2^31; a camera's orientation may swap them
};

/// Reads the header of a PNG, JPEG, BMP, WebP or TIFF (its first image); nullopt for other bytes, or if they end before
/// the size. Sources: PNG (W3C, 11.2.2), ITU-T T.81, BITMAPCOREHEADER and BITMAPINFOHEADER (Microsoft), RFC 9649, TIFF
/// 6.0 and BigTIFF.
std::optional<ImageHeader> ReadImageHeader(std::string_view bytes);

// Maximum size of still images and video frames: larger ones are refused before memory is allocated.

inline constexpr int64_t kMaxImagePixels = int64_t{1} << 26;

}  // namespace bodyloom
