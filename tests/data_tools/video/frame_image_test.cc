// SPDX-License-Identifier: Apache-2.0
// Rotations and mirrorings against the matrix's formula, against ffmpeg's, and in a phone's clip.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <vector>

#include <algorithm>
#include <array>
#include <set>
#include <string>

#include "data_tools/video/frame_image.h"

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/video_reader.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/data_tools/video/clip_maker.h"

namespace bodyloom::frame_image_test {
namespace {

/// a, b, c, d of the turns and mirror images of a square.
constexpr std::array<std::array<int, 4>, 8> kTurns = {{{1, 0, 0, 1},
                                                       {0, 1, -1, 0},
                                                       {-1, 0, 0, -1},
                                                       {0, -1, 1, 0},
                                                       {-1, 0, 0, 1},
                                                       {1, 0, 0, -1},
                                                       {0, 1, 1, 0},
                                                       {0, -1, -1, 0}}};

/// A picture with its pixels where the matrix's formula takes them.
Image Moved(const Image& image, const std::array<int, 4>& turn) {
  const auto [a, b, c, d] = turn;
  Image moved(a != 0 ? image.width : image.height, a != 0 ? image.height : image.width);
  for (int q = 0; q < image.height; ++q) {
    for (int p = 0; p < image.width; ++p) {
      const int x = a * p + c * q + (a + c < 0 ? moved.width - 1 : 0);
      const int y = b * p + d * q + (b + d < 0 ? moved.height - 1 : 0);
      std::copy_n(image.pixel(p, q), 3, moved.pixel(x, y));
    }
  }
  return moved;
}

TEST(DisplayMatrix, NearestOrientation) {
  EXPECT_EQ(OrientationOf(nullptr), DisplayOrientation());
  const int32_t upright[9] = {65536, 0, 0, 0, 65536, 0, 0, 0, 1 << 30};
  EXPECT_EQ(OrientationOf(upright), DisplayOrientation());
  const int32_t clockwise[9] = {0, 65536, 0, -65536, 0, 0, 0, 0, 1 << 30};
  EXPECT_EQ(OrientationOf(clockwise), (DisplayOrientation{true, true, false}));
  const int32_t nearly[9] = {-4000, 65000, 0, -65000, -4000, 0, 0, 0, 1 << 30};
  EXPECT_EQ(OrientationOf(nearly), (DisplayOrientation{true, true, false}));
  const int32_t edge[9] = {INT32_MIN, INT32_MIN, 0, INT32_MIN, INT32_MIN, 0, 0, 0, 0};
  EXPECT_EQ(OrientationOf(edge), (DisplayOrientation{false, true, true}));
}

TEST(DisplayMatrix, AllTurnsAndMirrorImages) {
  const TemporaryFolder folder;
  const std::string clip = folder.File("clip.mp4"), turned = folder.File("turned.mp4"),
                    shown = folder.File("shown.png");
  Ffmpeg(NumberedInput(folder, 7) + "-c:v libx264rgb -qp 0 " + clip);
  const std::string bytes = ReadFileBytes(clip);
  for (const auto& turn : kTurns) {
    WriteTurned(bytes, turn, turned);
    VideoReader reader(turned);
    reader.Skip(6);
    Image frame;
    ASSERT_TRUE(reader.Read(&frame));
    EXPECT_EQ(frame.width, reader.info().width);
    const std::string what = ::testing::PrintToString(turn);
    EXPECT_EQ(frame, Moved(NumberedImage(6), turn)) << what;
    Ffmpeg("-i " + turned + " -vf select='eq(n\\,6)' -frames:v 1 " + shown);
    EXPECT_EQ(frame, ReadImage(shown)) << what;
  }
}

TEST(DisplayMatrix, OrientationsFollowOneAnother) {
  const Image image = NumberedImage(5);
  for (int first = 0; first < 8; ++first) {
    for (int second = 0; second < 8; ++second) {
      const auto orientation = [](int bits) {
        return DisplayOrientation{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0};
      };
      const Image stepwise = Oriented(Oriented(image, orientation(first)), orientation(second));
      EXPECT_EQ(Oriented(image, Then(orientation(first), orientation(second))), stepwise) << first << ' ' << second;
    }
  }
  const auto clockwise = [&](int degrees) { return Oriented(image, ClockwiseTurn(degrees)); };
  EXPECT_EQ(clockwise(0), image);
  EXPECT_EQ(clockwise(90), Moved(image, {0, 1, -1, 0}));
  EXPECT_EQ(clockwise(180), Moved(image, {-1, 0, 0, -1}));
  EXPECT_EQ(clockwise(270), Moved(image, {0, -1, 1, 0}));
  EXPECT_THROW(ClockwiseTurn(45), std::invalid_argument);
}

TEST(DisplayMatrix, TurnsOfTheCallerForVideosAndImages) {
  const TemporaryFolder folder;
  const std::string clip = folder.File("clip.mp4"), still = folder.File("still.png");
  Ffmpeg(NumberedInput(folder, 3) + "-c:v libx264rgb -qp 0 " + clip);
  WriteImage(still, NumberedImage(0));
  for (const std::string& path : {clip, still}) {
    for (const int degrees : {0, 90, 180, 270}) {
      VideoReader reader(path, degrees);
      Image frame;
      ASSERT_TRUE(reader.Read(&frame));
      EXPECT_EQ(frame, Oriented(NumberedImage(0), ClockwiseTurn(degrees)));
      EXPECT_EQ(reader.info().width, frame.width);
      EXPECT_EQ(reader.info().stored_height, frame.height);
    }
    EXPECT_THROW(VideoReader(path, 30), std::invalid_argument);
  }
}

/// As ffmpeg notes a rotation when it is told to, which is by the opposite sense in some of its versions.
TEST(DisplayMatrix, NotedRotations) {
  const TemporaryFolder folder;
  const std::string clip = folder.File("clip.mp4"), turned = folder.File("turned.mov"),
                    shown = folder.File("shown.png");
  Ffmpeg(NumberedInput(folder, 12) + "-c:v libx264 -pix_fmt yuv420p -qp 4 " + clip);
  std::set<int> found;
  for (const std::string degrees : {"90", "180", "270"}) {
    Ffmpeg("-i " + clip + " -c copy -metadata:s:v:0 rotate=" + degrees + " " + turned);
    Ffmpeg("-i " + turned + " -vf select='eq(n\\,0)' -frames:v 1 " + shown);
    VideoReader reader(turned);
    EXPECT_EQ(reader.info().width, degrees == "180" ? 96 : 64);
    EXPECT_EQ(reader.info().height, degrees == "180" ? 64 : 96);
    Image frame;
    for (int i = 0; i < 12; ++i) {
      ASSERT_TRUE(reader.Read(&frame));
      if (i == 0) {
        EXPECT_LT(MeanDifference(frame, ReadImage(shown)), 2.5) << degrees;
      }
      for (int turn = 1; turn < 4; ++turn) {
        if (MeanDifference(frame, Moved(NumberedImage(i), kTurns[turn])) < 2.5) found.insert(12 * turn + i);
      }
    }
  }
  EXPECT_EQ(found.size(), 36U) << "every frame in every turn";
}

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

// Videos of pixels that are not square, wherever the file says so.

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

}  // namespace bodyloom::frame_image_test
