// SPDX-License-Identifier: Apache-2.0
// Videos of pixels that are not square, wherever the file says so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "data_tools/video/video_reader.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/data_tools/video/clip_maker.h"

namespace bodyloom::pixel_aspect_test {
namespace {

using ::testing::HasSubstr;

/// Smooth colours that tell the place in the scene, sampled by width × height pixels of a scene of 192 × 128.
Image Scene(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double u = (x + 0.5) * 192 / width, v = (y + 0.5) * 128 / height;
      uint8_t* p = image.pixel(x, y);
      p[0] = uint8_t(std::lround(60 + 0.6 * u));
      p[1] = uint8_t(std::lround(60 + v));
      p[2] = uint8_t(std::lround(128 + 40 * std::sin(0.05 * u) * std::cos(0.07 * v)));
    }
  }
  return image;
}

/// Writes ten frames of the scene in width × height stored pixels.
void WriteScene(const TemporaryFolder& folder, int width, int height, const std::string& arguments,
                const std::string& path) {
  WriteImage(folder.File("scene.png"), Scene(width, height));
  Ffmpeg("-loop 1 -framerate 30 -i " + folder.File("scene.png") + " -frames:v 10 " + arguments + " " + path);
}

Image FirstFrame(VideoReader* reader) {
  Image frame;
  EXPECT_TRUE(reader->Read(&frame));
  return frame;
}

TEST(PixelAspect, ShorterSideIsEnlargedWhereverTheRatioStands) {
  struct Case {
    int stored_width, stored_height;
    std::string name, arguments;
    int width = 192;
  };
  const std::string h264 = "-c:v libx264 -qp 4 -pix_fmt yuv420p ";
  const std::vector<Case> cases = {
      {96, 128, "stream.mp4", h264 + "-vf setsar=2"},
      {192, 64, "stream_wide.mp4", h264 + "-vf setsar=1/2"},
      {144, 128, "stream.mkv", h264 + "-vf setsar=4/3"},
      {144, 128, "container.mkv", "-c:v mjpeg -q:v 1 -pix_fmt yuvj420p -aspect 3:2"},
      {144, 128, "old.mpg", "-c:v mpeg2video -q:v 1 -r 30 -aspect 4:3", 171},
      {144, 128, "container.mov", "-c:v mpeg4 -q:v 1 -vf setsar=4/3"},
  };
  const TemporaryFolder folder;
  for (const Case& c : cases) {
    const std::string path = folder.File(c.name);
    WriteScene(folder, c.stored_width, c.stored_height, c.arguments, path);
    VideoReader reader(path);
    const VideoInfo& info = reader.info();
    EXPECT_EQ(info.stored_width, c.stored_width) << c.name;
    EXPECT_EQ(info.stored_height, c.stored_height) << c.name;
    EXPECT_EQ(info.width, c.width) << c.name;
    EXPECT_EQ(info.height, 128) << c.name;
    EXPECT_TRUE(info.IsAnamorphic());
    EXPECT_LT(MeanDifference(FirstFrame(&reader), Scene(c.width, 128)), 2) << c.name;
    EXPECT_THAT(reader.note(), HasSubstr(path + ": its pixels are not square"));
    EXPECT_THAT(reader.note(), HasSubstr("shown as " + std::to_string(c.width) + "x128"));
  }
}

TEST(PixelAspect, TurnedVideosAreEnlargedAsTheyAreStored) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.mp4"), turned = folder.File("turned.mp4");
  WriteScene(folder, 96, 128, "-c:v libx264 -qp 4 -pix_fmt yuv420p -vf setsar=2", path);
  WriteTurned(ReadFileBytes(path), {0, 1, -1, 0}, turned);
  VideoReader upright(path), reader(turned), back(turned, 270);
  EXPECT_EQ(reader.info().width, 128);
  EXPECT_EQ(reader.info().height, 192);
  EXPECT_EQ(reader.info().stored_width, 128);
  EXPECT_EQ(reader.info().stored_height, 96);
  EXPECT_EQ(FirstFrame(&back), FirstFrame(&upright)) << "the turn of the caller comes after that of the file";
  EXPECT_EQ(back.info().stored_width, 96);
}

TEST(PixelAspect, RatiosThatAreRoundingOrNonsenseAreIgnored) {
  const TemporaryFolder folder;
  for (const std::string sar : {"1", "1280/1281", "399/400", "100", "1/100"}) {
    const std::string path = folder.File("a.mp4");
    WriteScene(folder, 96, 64, "-c:v libx264 -qp 4 -pix_fmt yuv420p -vf setsar=" + sar, path);
    const VideoReader reader(path);
    EXPECT_EQ(reader.info().width, 96) << sar;
    EXPECT_EQ(reader.info().height, 64) << sar;
    EXPECT_FALSE(reader.info().IsAnamorphic());
    EXPECT_EQ(reader.note(), "");
  }
}

}  // namespace
}  // namespace bodyloom::pixel_aspect_test
