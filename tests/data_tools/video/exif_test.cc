// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/video/exif.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>

#include "bodyloom/data_tools/video/image_file.h"
#include "tests/data_tools/video/clip_maker.h"

namespace bodyloom {
namespace {

/// A TIFF structure as cameras write it: a folder with an orientation and a pointer to a folder with one entry.
std::string TiffWith(bool little, int tag, int type, int value) {
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

TEST(Exif, FocalLengthForFilm) {
  for (const bool little : {true, false}) {
    EXPECT_EQ(ReadExifFocal35mm(TiffWith(little, 0xA405, 3, 26)), 26);
    EXPECT_EQ(ReadExifFocal35mm(TiffWith(little, 0xA405, 3, 600)), 600);
    EXPECT_EQ(ReadExifFocal35mm(TiffWith(little, 0xA405, 3, 0)), 0) << "Exif: 0 is unknown";
    EXPECT_EQ(ReadExifFocal35mm(TiffWith(little, 0xA402, 3, 26)), 0) << "another entry";
    EXPECT_EQ(ReadExifFocal35mm(TiffWith(little, 0xA405, 5, 26)), 0) << "another type";
  }
}

TEST(Exif, DamagedOnesHaveNoneAndAreNotReadBeyond) {
  const std::string whole = TiffWith(true, 0xA405, 3, 26);
  for (size_t length = 0; length < whole.size(); ++length) {
    const std::string cut(whole.data(), length);
    const double value = ReadExifFocal35mm(cut);
    EXPECT_TRUE(value == 0 || value == 26) << length;
  }
  std::mt19937 random(3);
  for (int i = 0; i < 20000; ++i) {
    std::string changed = whole;
    for (int n = 0; n < 3; ++n) changed[random() % changed.size()] = static_cast<char>(random());
    const double value = ReadExifFocal35mm(changed);
    EXPECT_TRUE(value >= 0 && value < 65536);
  }
}

TEST(Exif, OfAPhotographAndOfAQuickTimeVideo) {
  const TemporaryFolder folder;
  const std::string jpeg = EncodeImage(Image(64, 48, Colour{90, 120, 30}), "a.jpg");
  const std::string exif = std::string("Exif\0\0", 6) + TiffWith(false, 0xA405, 3, 28);
  const auto length = static_cast<unsigned>(exif.size() + 2);
  const std::string segment = {'\xFF', '\xE1', static_cast<char>(length >> 8), static_cast<char>(length)};
  WriteFileAtomically(folder.File("lens.jpg"), jpeg.substr(0, 2) + segment + exif + jpeg.substr(2));
  WriteFileAtomically(folder.File("bare.jpg"), jpeg);
  EXPECT_EQ(VideoReader(folder.File("lens.jpg")).info().focal_35mm_mm, 28);
  EXPECT_EQ(VideoReader(folder.File("bare.jpg")).info().focal_35mm_mm, 0);

  const std::string key = "com.apple.quicktime.camera.focal_length.35mm_equivalent";
  const std::string input = NumberedInput(folder, 4);
  for (const auto& [note, expected] : {std::pair("26", 26.0), std::pair("-13", 0.0), std::pair("soft", 0.0)}) {
    Ffmpeg(input + "-c:v libx264 -pix_fmt yuv420p -movflags use_metadata_tags -metadata " + key + "=" + note + " " +
           folder.File("a.mov"));
    EXPECT_EQ(VideoReader(folder.File("a.mov")).info().focal_35mm_mm, expected) << note;
  }
}

}  // namespace
}  // namespace bodyloom
