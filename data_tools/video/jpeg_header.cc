// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/video/jpeg_header.h"

#include <cstddef>
#include <cstdint>

#include "bodyloom/data_tools/video/exif.h"

namespace bodyloom {

std::optional<JpegHeader> ReadJpegHeader(std::string_view bytes) {
  const auto byte = [&](size_t i) { return i < bytes.size() ? static_cast<uint8_t>(bytes[i]) : uint8_t{0}; };
  const auto word = [&](size_t i) { return int{byte(i)} << 8 | byte(i + 1); };
  if (byte(0) != 0xFF || byte(1) != 0xD8) return std::nullopt;
  JpegHeader header;
  for (size_t at = 2; at + 3 < bytes.size();) {
    if (byte(at) != 0xFF) return header;  // no marker where one should be: the decoder will judge
    const uint8_t marker = byte(at + 1);
    if (marker == 0xFF) {  // filling
      ++at;
      continue;
    }
    const bool frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (frame) {
      header.height = word(at + 5);
      header.width = word(at + 7);
      header.components = byte(at + 9);
    }
    constexpr std::string_view kExif("Exif\0\0", 6);
    const auto length = static_cast<size_t>(word(at + 2));
    if (marker == 0xE1 && length >= 8 && bytes.substr(at + 4).starts_with(kExif)) {
      header.focal_35mm_mm = ReadExifFocal35mm(bytes.substr(at + 10, length - 8));
    }
    at += 2 + length;
    if (marker != 0xDA) continue;
    // Coded data never hold this pair but as the marker; a thumbnail's own lies before the scan.
    header.ends = bytes.find("\xFF\xD9", at) != std::string_view::npos;
    return header;
  }
  return header;
}

}  // namespace bodyloom
