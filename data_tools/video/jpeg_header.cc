// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/jpeg_header.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

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

namespace {

constexpr uint64_t kExifFolder = 0x8769, kFocal35mm = 0xA405, kShort = 3;

/// Offset of the entry of a tag in the directory at `folder`; 0: none.
size_t FindEntry(const HeaderBytes& bytes, bool big_endian, size_t folder, uint64_t tag) {
  constexpr size_t kEntryBytes = 12;
  const uint64_t count = bytes.Number(folder, 2, big_endian);
  size_t at = folder + 2;
  for (uint64_t i = 0; i < count && at + kEntryBytes <= bytes.size(); ++i, at += kEntryBytes) {
    if (bytes.Number(at, 2, big_endian) == tag) return at;
  }
  return 0;
}

}  // namespace

double ReadExifFocal35mm(std::string_view tiff) {
  using namespace std::string_view_literals;
  const HeaderBytes bytes(tiff);
  const bool big_endian = bytes.Has(0, "MM\0*"sv);
  if (!big_endian && !bytes.Has(0, "II*\0"sv)) return 0;
  const auto number = [&](size_t at, int count) { return bytes.Number(at, count, big_endian); };
  const size_t pointer = FindEntry(bytes, big_endian, number(4, 4), kExifFolder);
  if (pointer == 0) return 0;
  const size_t entry = FindEntry(bytes, big_endian, number(pointer + 8, 4), kFocal35mm);
  return entry != 0 && number(entry + 2, 2) == kShort ? static_cast<double>(number(entry + 8, 2)) : 0;
}

}  // namespace bodyloom
