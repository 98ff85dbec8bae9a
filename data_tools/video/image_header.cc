// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/image_header.h"

#include <cstdlib>

namespace bodyloom {
namespace {

/// At most 2^31, so that the number of pixels does not overflow.
int64_t Side(uint64_t value) {
  constexpr uint64_t kMaximum = uint64_t{1} << 31;
  return static_cast<int64_t>(value < kMaximum ? value : kMaximum);
}

ImageHeader Bmp(const HeaderBytes& bytes) {
  if (bytes.Little(14, 4) == 12) {
    return {Side(bytes.Little(18, 2)), Side(bytes.Little(20, 2))};
  }
  // Rows from the top have a negative height.
  const auto height = static_cast<int32_t>(bytes.Little(22, 4));
  return {static_cast<int32_t>(bytes.Little(18, 4)), std::abs(int64_t{height})};
}

ImageHeader WebP(const HeaderBytes& bytes) {
  constexpr uint64_t k14Bits = 0x3FFF;
  if (bytes.Has(12, "VP8X")) return {Side(bytes.Little(24, 3) + 1), Side(bytes.Little(27, 3) + 1)};
  if (bytes.Has(12, "VP8L")) {
    const uint64_t sides = bytes.Little(21, 4);
    return {Side((sides & k14Bits) + 1), Side((sides >> 14 & k14Bits) + 1)};
  }
  if (bytes.Has(12, "VP8 ")) return {Side(bytes.Little(26, 2) & k14Bits), Side(bytes.Little(28, 2) & k14Bits)};
  return {};
}

ImageHeader Tiff(const HeaderBytes& bytes, bool big_endian) {
  const auto number = [&](size_t at, int count) { return bytes.Number(at, count, big_endian); };
  const bool big_tiff = number(2, 2) == 43;
  const uint64_t directory = big_tiff ? number(8, 8) : number(4, 4);
  if (directory >= bytes.size()) return {};
  const uint64_t entries = number(directory, big_tiff ? 8 : 2);
  const size_t entry_size = big_tiff ? 20 : 12;
  ImageHeader header;
  size_t at = directory + (big_tiff ? 8 : 2);
  for (uint64_t i = 0; i < entries && at + entry_size <= bytes.size(); ++i, at += entry_size) {
    const uint64_t tag = number(at, 2), type = number(at + 2, 2);
    constexpr uint64_t kWidth = 256, kHeight = 257, kShort = 3, kLong8 = 16;
    if (tag != kWidth && tag != kHeight) continue;
    const uint64_t value = number(at + (big_tiff ? 12 : 8), type == kShort ? 2 : type == kLong8 ? 8 : 4);
    (tag == kWidth ? header.width : header.height) = Side(value);
  }
  return header;
}

ImageHeader Of(std::string_view file) {
  using namespace std::string_view_literals;
  const HeaderBytes bytes(file);
  if (bytes.Has(0, "\x89PNG\r\n\x1a\n"sv) && bytes.Has(12, "IHDR"sv)) {
    return {Side(bytes.Big(16, 4)), Side(bytes.Big(20, 4))};
  }
  if (const auto jpeg = ReadJpegHeader(file)) return {jpeg->width, jpeg->height};
  if (bytes.Has(0, "BM"sv)) return Bmp(bytes);
  if (bytes.Has(0, "RIFF"sv) && bytes.Has(8, "WEBP"sv)) return WebP(bytes);
  if (bytes.Has(0, "II*\0"sv) || bytes.Has(0, "II+\0"sv)) return Tiff(bytes, false);
  if (bytes.Has(0, "MM\0*"sv) || bytes.Has(0, "MM\0+"sv)) return Tiff(bytes, true);
  return {};
}

}  // namespace

std::optional<ImageHeader> ReadImageHeader(std::string_view bytes) {
  const ImageHeader header = Of(bytes);
  if (header.width < 1 || header.height < 1) return std::nullopt;
  return header;
}

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
