// SPDX-License-Identifier: Apache-2.0
/// Makes photos with Exif data of the lens.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace bodyloom {

/// A TIFF structure as cameras write it: a folder with an orientation and a pointer to a folder with one entry.
inline std::string TiffWith(bool little, int tag, int type, int value) {
  std::string bytes = little ? "II" : "MM";
  const auto put = [&](uint32_t number, int size) {
    for (int i = 0; i < size; ++i) bytes += static_cast<char>(number >> (8 * (little ? i : size - 1 - i)));
  };
  const auto entry = [&](int of_tag, int of_type, uint32_t of_value) {
    put(static_cast<uint32_t>(of_tag), 2), put(static_cast<uint32_t>(of_type), 2), put(1, 4);
    if (of_type == 3) {
      put(of_value, 2), put(0, 2);
    } else {
      put(of_value, 4);
    }
  };
  put(42, 2), put(8, 4);
  put(2, 2), entry(0x0112, 3, 1), entry(0x8769, 4, 38), put(0, 4);
  EXPECT_EQ(bytes.size(), 38U);
  put(1, 2), entry(tag, type, static_cast<uint32_t>(value)), put(0, 4);
  return bytes;
}

/// A JPEG with this TIFF structure in a segment of Exif.
inline std::string WithExif(const std::string& jpeg, const std::string& tiff) {
  const std::string exif = std::string("Exif\0\0", 6) + tiff;
  const auto length = static_cast<unsigned>(exif.size() + 2);
  const std::string segment = {'\xFF', '\xE1', static_cast<char>(length >> 8), static_cast<char>(length)};
  return jpeg.substr(0, 2) + segment + exif + jpeg.substr(2);
}

}  // namespace bodyloom
