// SPDX-License-Identifier: Apache-2.0
/// Reads the size in an image file's header, so that a file that claims a billion pixels is refused before a decoder
/// allocates memory for them.
#pragma once

#include <cstddef>
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

// Reads the header of a JPEG without decoding the file.

struct JpegHeader {
  int width = 0, height = 0;  ///< 0: there is no frame header
  int components = 3;         ///< 1 grey, 3 colours, 4 inks
  double focal_35mm_mm = 0;   ///< from its Exif (ReadExifFocal35mm); 0: it has none
  bool ends = false;          ///< an end-of-image marker comes after the first scan began
};

/// Reads a file's bytes; nullopt when they are not a JPEG. Source: ITU-T T.81, Annex B.
std::optional<JpegHeader> ReadJpegHeader(std::string_view bytes);

// Lens data in a photograph's Exif.

/// FocalLengthIn35mmFilm (tag 0xA405), millimetres: the focal length that has the same diagonal angle of view on film
/// of 36 mm × 24 mm. Read from the TIFF structure of an Exif segment; 0 if it is missing, marked as unknown, or
/// damaged. Source: Exif 2.32 (CIPA DC-008), 4.6.
double ReadExifFocal35mm(std::string_view tiff);

// Integers in the header of an image file. Internal to data_tools/video.

/// Integers in a file's bytes; zero beyond the end.
class HeaderBytes {
 public:
  explicit HeaderBytes(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] bool Has(size_t at, std::string_view text) const {
    return bytes_.size() >= at + text.size() && bytes_.substr(at, text.size()) == text;
  }
  [[nodiscard]] uint64_t Number(size_t at, int count, bool big_endian) const {
    uint64_t value = 0;
    for (int i = 0; i < count; ++i) value = value << 8 | Byte(at + (big_endian ? i : count - 1 - i));
    return value;
  }
  [[nodiscard]] uint64_t Big(size_t at, int count) const { return Number(at, count, true); }
  [[nodiscard]] uint64_t Little(size_t at, int count) const { return Number(at, count, false); }
  [[nodiscard]] size_t size() const { return bytes_.size(); }

 private:
  [[nodiscard]] uint8_t Byte(size_t at) const { return at < bytes_.size() ? static_cast<uint8_t>(bytes_[at]) : 0; }
  std::string_view bytes_;
};

}  // namespace bodyloom
