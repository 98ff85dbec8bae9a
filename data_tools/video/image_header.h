// SPDX-License-Identifier: Apache-2.0
/// The size in an image file's header, so that a few bytes that promise a billion pixels are refused before a decoder
/// makes room for them.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace bodyloom {

struct ImageHeader {
  int64_t width = 0, height = 0;  ///< pixels as stored, 1 to 2^31; a camera's orientation may swap them
};

/// Of a PNG, JPEG, BMP, WebP or TIFF (its first picture); nullopt when the bytes are none or end before the size.
/// Sources: PNG (W3C, 11.2.2), ITU-T T.81, BITMAPCOREHEADER and BITMAPINFOHEADER (Microsoft), RFC 9649, TIFF 6.0 and
/// BigTIFF.
std::optional<ImageHeader> ReadImageHeader(std::string_view bytes);

// How large a picture may be, still or moving: files that promise more are refused before memory is taken.

inline constexpr int64_t kMaxPicturePixels = int64_t{1} << 26;

}  // namespace bodyloom
