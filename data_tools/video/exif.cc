// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/video/exif.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "bodyloom/data_tools/video/header_bytes.h"

namespace bodyloom {
namespace {

constexpr uint64_t kExifFolder = 0x8769, kFocal35mm = 0xA405, kShort = 3;

/// Where the entry of a tag is in the folder at `folder`; 0: nowhere.
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
