// SPDX-License-Identifier: Apache-2.0
// Image sizes in headers against OpenCV's encoders, and against hand-made files of formats that OpenCV cannot write.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cstdint>

#include <opencv2/imgcodecs.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "data_tools/video/image_header.h"

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/image_file.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/data_tools/video/clip_maker.h"
#include "tests/data_tools/video/exif_maker.h"

namespace bodyloom::image_header_test {
namespace {

using namespace std::string_literals;

std::string Encoded(const std::string& extension, int width, int height, const std::vector<int>& parameters = {}) {
  const cv::Mat image(height, width, CV_8UC3, cv::Scalar(20, 120, 220));
  std::vector<uchar> bytes;
  EXPECT_TRUE(cv::imencode(extension, image, bytes, parameters));
  return {bytes.begin(), bytes.end()};
}

std::string Number(uint64_t value, int count, bool big_endian) {
  std::string bytes(count, '\0');
  for (int i = 0; i < count; ++i) bytes[big_endian ? count - 1 - i : i] = static_cast<char>(value >> 8 * i);
  return bytes;
}

void ExpectSize(const std::string& bytes, int64_t width, int64_t height, const std::string& what) {
  const auto header = ReadImageHeader(bytes);
  ASSERT_TRUE(header.has_value()) << what;
  EXPECT_EQ(header->width, width) << what;
  EXPECT_EQ(header->height, height) << what;
}

TEST(ImageHeader, SizesAreThoseThatWereEncoded) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(37, 23), std::pair(300, 5), std::pair(4, 700)}) {
    for (const char* extension : {".png", ".jpg", ".bmp", ".tiff", ".webp"}) {
      ExpectSize(Encoded(extension, width, height), width, height, extension);
    }
    ExpectSize(Encoded(".webp", width, height, {cv::IMWRITE_WEBP_QUALITY, 101}), width, height, "lossless WebP");
    ExpectSize(Encoded(".jpg", width, height, {cv::IMWRITE_JPEG_PROGRESSIVE, 1}), width, height, "progressive JPEG");
  }
}

TEST(ImageHeader, FormatsThatOpenCvDoesNotWrite) {
  ExpectSize("BM"s + std::string(12, '\0') + Number(12, 4, false) + Number(640, 2, false) + Number(480, 2, false), 640,
             480, "BMP of OS/2");
  ExpectSize("BM"s + std::string(12, '\0') + Number(40, 4, false) + Number(640, 4, false) +
                 Number(static_cast<uint32_t>(-480), 4, false),
             640, 480, "BMP from the top");
  ExpectSize("RIFF\0\0\0\0WEBPVP8X"s + Number(10, 4, false) + Number(0, 4, false) + Number(1999, 3, false) +
                 Number(99999, 3, false),
             2000, 100000, "extended WebP");
  for (const bool big_endian : {false, true}) {
    const auto n = [&](uint64_t value, int count) { return Number(value, count, big_endian); };
    const std::string order = big_endian ? "MM" : "II";
    ExpectSize(order + n(42, 2) + n(10, 4) + n(0, 2) + n(3, 2) + n(254, 2) + n(4, 2) + n(1, 4) + n(0, 4) + n(256, 2) +
                   n(3, 2) + n(1, 4) + n(1234, 2) + n(0, 2) + n(257, 2) + n(4, 2) + n(1, 4) + n(70000, 4),
               1234, 70000, "TIFF " + order);
    ExpectSize(order + n(43, 2) + n(8, 2) + n(0, 2) + n(16, 8) + n(2, 8) + n(256, 2) + n(16, 2) + n(1, 8) +
                   n(uint64_t{1} << 40, 8) + n(257, 2) + n(4, 2) + n(1, 8) + n(77, 4) + n(0, 4),
               int64_t{1} << 31, 77, "BigTIFF " + order);
  }
}

TEST(ImageHeader, SidesThatNoImageHasCanBeMultiplied) {
  std::string bytes = Encoded(".png", 37, 23);
  bytes.replace(16, 8, 8, '\xFF');
  const auto header = ReadImageHeader(bytes);
  ASSERT_TRUE(header.has_value());
  EXPECT_EQ(header->width * header->height, int64_t{1} << 62);
}

TEST(ImageHeader, NothingIsSaidOfWhatIsCutOrNoImage) {
  for (const char* extension : {".png", ".jpg", ".bmp", ".tiff", ".webp"}) {
    const std::string bytes = Encoded(extension, 37, 23);
    for (size_t size = 0; size < bytes.size(); ++size) {
      const auto header = ReadImageHeader(std::string_view(bytes).substr(0, size));
      if (!header) continue;
      // Numbers themselves may be cut: what is missing is zero.
      EXPECT_LE(header->width, 37 << 8) << extension << " of " << size << " bytes";
      EXPECT_LE(header->height, 23 << 8) << extension << " of " << size << " bytes";
    }
    EXPECT_FALSE(ReadImageHeader(std::string_view(bytes).substr(0, 12)).has_value()) << extension;
  }
  std::mt19937 random(7);
  for (const std::string& beginning : {"\x89PNG\r\n\x1a\n"s, "\xFF\xD8"s, "BM"s, "RIFF"s, "II*\0"s, "MM\0+"s, ""s}) {
    for (int k = 0; k < 2000; ++k) {
      std::string bytes = beginning;
      for (int i = static_cast<int>(random() % 80); i > 0; --i) bytes += static_cast<char>(random());
      const auto header = ReadImageHeader(bytes);
      if (header) {
        EXPECT_GE(header->width * header->height, 1);
      }
    }
  }
}

/// The size is named: it was refused for it, not by a decoder that had already made room for a billion pixels.
TEST(ImageHeader, AFewBytesDoNotTakeTheMemoryOfABillionPixels) {
  const TemporaryFolder folder;
  std::string bytes = Encoded(".png", 37, 23);
  bytes.replace(16, 8, Number(32768, 4, true) + Number(32768, 4, true));
  std::string jpeg = Encoded(".jpg", 37, 23);
  const size_t frame = jpeg.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  jpeg.replace(frame + 5, 4, Number(60000, 2, true) + Number(50000, 2, true));
  const std::pair<std::string, std::string> files[] = {{"32768x32768", bytes}, {"50000x60000", jpeg}};
  for (const auto& [size, file] : files) {
    const std::string path = folder.File("large");
    WriteFileAtomically(path, file);
    EXPECT_NE(FileErrorOf(path, [&] { ReadImage(path); }).find(size), std::string::npos);
  }
}

TEST(ImageHeader, AnAnimatedWebpIsNamed) {
  std::string bytes("RIFF\x74\xd0\0\0WEBPVP8X\x0a\0\0\0\x12\0\0\0\x67\x01\0\x67\x01\0ANIM\x06\0\0\0", 38);
  EXPECT_THAT(FileErrorOf("a.webp", [&] { DecodeImage(bytes, "a.webp"); }),
              ::testing::HasSubstr("an animated WebP, which neither"));
  bytes[20] = 0x10;
  EXPECT_THAT(FileErrorOf("a.webp", [&] { DecodeImage(bytes, "a.webp"); }),
              ::testing::HasSubstr("not an image that can be decoded"))
      << "a broken one that stands still";
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

}  // namespace bodyloom::image_header_test
