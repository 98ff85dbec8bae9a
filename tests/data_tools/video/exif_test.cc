// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/jpeg_header.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>

#include "data_tools/video/image_file.h"
#include "tests/data_tools/video/clip_maker.h"
#include "tests/data_tools/video/exif_maker.h"

namespace bodyloom::exif_test {
namespace {

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
  WriteFileAtomically(folder.File("lens.jpg"), WithExif(jpeg, TiffWith(false, 0xA405, 3, 28)));
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
}  // namespace bodyloom::exif_test
