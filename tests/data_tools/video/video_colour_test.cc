// SPDX-License-Identifier: Apache-2.0
// Colours against the standards' formulas: clips with exactly known YCbCr values (lossless FFV1).
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "data_tools/video/video_reader.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/data_tools/video/clip_maker.h"

namespace bodyloom::video_colour_test {
namespace {

struct Ycbcr {
  double y = 16, cb = 128, cr = 128;  ///< on the scale of eight bits
};

struct Clip {
  std::string format = "yuv444p", tags;  ///< ffmpeg's names and options
  int width = 64, height = 48, bits = 8;
  int chroma_w = 1, chroma_h = 1;  ///< luma pixels a chroma sample
  /// Of the picture's planes: plane, column and row of the sample there.
  std::function<double(int plane, int x, int y)> value;
};

/// A clip of one frame.
std::string Written(const TemporaryFolder& folder, const Clip& clip) {
  const std::string raw = folder.File("raw");
  std::string path = folder.File("clip.mkv");
  std::ofstream file(raw, std::ios::binary);
  for (int plane = 0; plane < 3; ++plane) {
    const int w = plane == 0 ? clip.width : (clip.width + clip.chroma_w - 1) / clip.chroma_w;
    const int h = plane == 0 ? clip.height : (clip.height + clip.chroma_h - 1) / clip.chroma_h;
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        const auto value = static_cast<int>(std::lround(clip.value(plane, x, y) * (1 << (clip.bits - 8))));
        file.put(static_cast<char>(value & 0xFF));
        if (clip.bits > 8) file.put(static_cast<char>(value >> 8));
      }
    }
  }
  file.close();
  Ffmpeg("-f rawvideo -pix_fmt " + clip.format + " -s " + std::to_string(clip.width) + "x" +
         std::to_string(clip.height) + " -i " + raw + " -c:v ffv1 " + clip.tags + " " + path);
  return path;
}

/// Blue, green, red by the luma weights of red and blue (BT.601: 0.299, 0.114; BT.709: 0.2126, 0.0722).
std::vector<double> Bgr(const Ycbcr& colour, double kr, double kb, bool full) {
  const double y = full ? colour.y / 255 : (colour.y - 16) / 219;
  const double u = (colour.cb - 128) / (full ? 255 : 224), v = (colour.cr - 128) / (full ? 255 : 224);
  const double red = y + 2 * (1 - kr) * v, blue = y + 2 * (1 - kb) * u;
  const double green = (y - kr * red - kb * blue) / (1 - kr - kb);
  std::vector<double> bgr = {blue, green, red};
  for (double& value : bgr) value = std::clamp(255 * value, 0.0, 255.0);
  return bgr;
}

Image FirstFrame(const std::string& path) {
  Image frame;
  VideoReader reader(path);
  EXPECT_TRUE(reader.Read(&frame));
  EXPECT_FALSE(reader.Read(&frame));
  return frame;
}

/// Sixteen colours in blocks of 16x12 pixels, some of them outside what screens show.
Ycbcr BlockColour(int x, int y) {
  const int k = x / 16 + 4 * (y / 12);
  return {40.0 + 12 * k, 128.0 + 50 * std::cos(1.3 * k), 128.0 + 50 * std::sin(2.1 * k)};
}

double Component(const Ycbcr& colour, int plane) { return plane == 0 ? colour.y : plane == 1 ? colour.cb : colour.cr; }

/// Blocks of colours in the middle of which the reader must find the formula's, to the nearest level.
void ExpectBlocks(Clip clip, double kr, double kb, bool full, double tolerance = 0.6) {
  const TemporaryFolder folder;
  const double steps = 1 << (clip.bits - 8);
  const auto at = [&](int plane, int x, int y) {
    return std::round(Component(BlockColour(x, y), plane) * steps) / steps;
  };
  clip.value = [&](int plane, int x, int y) {
    return at(plane, plane == 0 ? x : x * clip.chroma_w, plane == 0 ? y : y * clip.chroma_h);
  };
  const Image frame = FirstFrame(Written(folder, clip));
  ASSERT_EQ(frame.width, clip.width);
  ASSERT_EQ(frame.height, clip.height);
  int compared = 0;
  for (int y = 6; y < clip.height; y += 12) {
    for (int x = 8; x < clip.width; x += 16, ++compared) {
      const std::vector<double> expected = Bgr({at(0, x, y), at(1, x, y), at(2, x, y)}, kr, kb, full);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(frame.pixel(x, y)[c], expected[c], tolerance)
            << clip.format << " " << clip.tags << ", channel " << c << " at " << x << ", " << y;
      }
    }
  }
  EXPECT_GT(compared, 4);
}

TEST(VideoColour, SpaceAndRangeAreTheFilesOwn) {
  for (const auto& [format, w, h] : {std::tuple("yuv420p", 2, 2), std::tuple("yuv422p", 2, 1),
                                     std::tuple("yuv444p", 1, 1), std::tuple("yuv440p", 1, 2)}) {
    Clip clip;
    clip.format = format;
    clip.chroma_w = w, clip.chroma_h = h;
    ExpectBlocks(clip, 0.299, 0.114, false);  // said nowhere: BT.601, as ffmpeg takes it
    clip.tags = "-colorspace smpte170m -color_range tv";
    ExpectBlocks(clip, 0.299, 0.114, false);
    clip.tags = "-colorspace bt709 -color_range tv";
    ExpectBlocks(clip, 0.2126, 0.0722, false);
    clip.tags = "-colorspace bt709 -color_range pc";
    ExpectBlocks(clip, 0.2126, 0.0722, true);
    clip.tags = "-colorspace bt2020nc -color_range tv";
    ExpectBlocks(clip, 0.2627, 0.0593, false);
  }
}

TEST(VideoColour, MoreThanEightBits) {
  for (const auto& [format, bits] : {std::pair("yuv420p10le", 10), std::pair("yuv420p12le", 12)}) {
    Clip clip;
    clip.format = format;
    clip.bits = bits;
    clip.chroma_w = clip.chroma_h = 2;
    clip.tags = "-colorspace bt709 -color_range tv";
    ExpectBlocks(clip, 0.2126, 0.0722, false);
  }
}

TEST(VideoColour, OddSizes) {
  for (const auto& [format, w, h] : {std::tuple("yuv420p", 2, 2), std::tuple("yuv444p", 1, 1)}) {
    Clip clip;
    clip.format = format;
    clip.width = 33, clip.height = 47;
    clip.chroma_w = w, clip.chroma_h = h;
    ExpectBlocks(clip, 0.299, 0.114, false);
    clip.width = 1, clip.height = 1;
    clip.value = [](int, int, int) { return 128; };
    const TemporaryFolder folder;
    const Image frame = FirstFrame(Written(folder, clip));
    ASSERT_EQ(frame.width * frame.height, 1);
    EXPECT_NEAR(frame.pixel(0, 0)[0], 112 * 255 / 219.0, 0.6);
  }
}

/// A ramp of chroma tells to a fraction of a pixel where it was sampled.
TEST(VideoColour, ChromaIsWhereItWasSampled) {
  struct Case {
    const char* location;
    double x, y;  ///< of the first chroma sample, in luma pixels from the first one's centre
  };
  for (const Case& c : {Case{"left", 0, 0.5}, Case{"center", 0.5, 0.5}, Case{"topleft", 0, 0}}) {
    for (const bool along_rows : {true, false}) {
      const TemporaryFolder folder;
      Clip clip;
      clip.format = "yuv420p";
      clip.tags = std::string("-chroma_sample_location ") + c.location;
      clip.chroma_w = clip.chroma_h = 2;
      constexpr double kStep = 6;  // a luma pixel: 12 a chroma sample
      const auto cb = [&](double x, double y) { return 40 + 2 * kStep * (along_rows ? x : y); };
      clip.value = [&](int plane, int x, int y) {
        return plane == 0 ? 100 : plane == 2 ? 128 : std::min(cb(x, y), 230.0);
      };
      const Image frame = FirstFrame(Written(folder, clip));
      double worst = 0;
      for (int k = 6; k < 24; ++k) {
        const int x = along_rows ? k : 20, y = along_rows ? 20 : k;
        const Ycbcr expected = {100, cb((x - c.x) / 2, (y - c.y) / 2), 128};
        worst = std::max(worst, std::abs(frame.pixel(x, y)[1] - Bgr(expected, 0.299, 0.114, false)[1]));
      }
      EXPECT_LT(worst, 0.8) << c.location << (along_rows ? " along rows" : " along columns");
    }
  }
}

TEST(VideoColour, GreyAndRgbKeepEveryLevel) {
  const TemporaryFolder folder;
  Image ramp(256, 8);
  for (int x = 0; x < 256; ++x) {
    for (int y = 0; y < 8; ++y) std::fill_n(ramp.pixel(x, y), 3, static_cast<uint8_t>(x));
  }
  WriteImage(folder.File("ramp.png"), ramp);
  const std::string path = folder.File("clip.mkv");
  for (const std::string format : {"gray", "bgr0", "gbrp"}) {
    Ffmpeg("-i " + folder.File("ramp.png") + " -pix_fmt " + format + " -c:v ffv1 " + path);
    EXPECT_EQ(FirstFrame(path), ramp) << format;
  }
  Ffmpeg("-i " + folder.File("ramp.png") + " -pix_fmt yuvj444p -c:v mjpeg -q:v 1 " + path);
  EXPECT_LT(MeanDifference(FirstFrame(path), ramp), 1) << "JPEG's full range";
}

}  // namespace
}  // namespace bodyloom::video_colour_test
