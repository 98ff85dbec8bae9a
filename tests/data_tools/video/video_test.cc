// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_reader.h"
#include "data_tools/video/video_writer.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/data_tools/video/clip_maker.h"
#include "tests/data_tools/video/exif_maker.h"
#include "tests/support/paths.h"

namespace bodyloom::video_test {
namespace {

namespace fs = std::filesystem;

void WriteClip(const std::string& path, int frames, int width = 96, int height = 64, double fps = 25) {
  VideoWriter writer(path, width, height, fps);
  for (int i = 0; i < frames; ++i) writer.Write(NumberedImage(i, width, height));
  writer.Finish();
}

int NumFilesIn(const fs::path& folder) {
  return static_cast<int>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(Video, ReturnsTheFramesThatWereWritten) {
  const TemporaryFolder folder;
  const std::string path = folder.File("clip.mp4");
  WriteClip(path, 20);
  EXPECT_EQ(NumFilesIn(folder.File("")), 1) << "no temporary file may stay behind";
  VideoReader reader(path);
  EXPECT_EQ(reader.info().width, 96);
  EXPECT_EQ(reader.info().height, 64);
  EXPECT_NEAR(reader.info().fps, 25, 1e-9);
  EXPECT_EQ(reader.info().num_frames, 20);
  Image frame;
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(reader.next_frame(), i);
    ASSERT_TRUE(reader.Read(&frame)) << "frame " << i;
    EXPECT_EQ(NumberOf(frame), i);
    EXPECT_NEAR(frame.at(90, 8).red, 50, 12);
  }
  EXPECT_FALSE(reader.Read(&frame));
}

TEST(Video, OddSidesAreMadeEven) {
  const TemporaryFolder folder;
  const std::string path = folder.File("odd.mp4");
  WriteClip(path, 5, 95, 63);
  VideoReader reader(path);
  EXPECT_EQ(reader.info().width, 96);
  EXPECT_EQ(reader.info().height, 64);
  Image frame;
  ASSERT_TRUE(reader.Read(&frame));
  EXPECT_EQ(NumberOf(frame), 0);
}

TEST(Video, SameFramesGiveTheSameBytes) {
  const TemporaryFolder folder;
  WriteClip(folder.File("a.mp4"), 12);
  WriteClip(folder.File("b.mp4"), 12);
  EXPECT_EQ(ReadFileBytes(folder.File("a.mp4")), ReadFileBytes(folder.File("b.mp4")));
}

/// Colours go to YCbCr and come back by the same matrix, which the file names.
TEST(Video, ColoursComeBack) {
  const TemporaryFolder folder;
  const std::string path = folder.File("clip.mp4");
  Image image(64, 48);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const int k = x / 16 + 4 * (y / 12);
      uint8_t* p = image.pixel(x, y);
      p[0] = 16 * k, p[1] = 255 - 13 * k, p[2] = 40 + 11 * (k % 7);
    }
  }
  VideoWriter writer(path, 64, 48, 25);
  for (int i = 0; i < 3; ++i) writer.Write(image);
  writer.Finish();
  VideoReader reader(path);
  Image frame;
  ASSERT_TRUE(reader.Read(&frame));
  for (int y = 6; y < 48; y += 12) {
    for (int x = 8; x < 64; x += 16) {
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(frame.pixel(x, y)[c], image.pixel(x, y)[c], 8) << x << ", " << y;
    }
  }
}

TEST(Video, SkipsFrames) {
  const TemporaryFolder folder;
  const std::string path = folder.File("clip.mp4");
  WriteClip(path, 10);
  VideoReader reader(path);
  EXPECT_EQ(reader.Skip(7), 7);
  Image frame;
  ASSERT_TRUE(reader.Read(&frame));
  EXPECT_EQ(NumberOf(frame), 7);
  EXPECT_EQ(reader.Skip(100), 2);
}

TEST(Video, UnfinishedFileDoesNotAppear) {
  const TemporaryFolder folder;
  {
    VideoWriter writer(folder.File("clip.mp4"), 96, 64, 25);
    for (int i = 0; i < 5; ++i) writer.Write(NumberedImage(i));
  }
  EXPECT_EQ(NumFilesIn(folder.File("")), 0);
}

TEST(Video, AFailedWriteLeavesTheOldFile) {
  const TemporaryFolder folder;
  const std::string path = folder.File("clip.mp4");
  WriteClip(path, 6);
  const std::string before = ReadFileBytes(path);
  VideoWriter empty(path, 96, 64, 25);
  FileErrorOf(path, [&] { empty.Finish(); });
  EXPECT_EQ(ReadFileBytes(path), before);
}

TEST(Video, AFullDiskIsReported) {
  const TemporaryFolder folder;
  const std::string path = folder.File("clip.mp4");
  // A limit on the size of files stands in for the full disk; the signal it raises is set aside, so that writing fails.
  rlimit old_limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = old_limit;
  small.rlim_cur = 4096;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string message;
  {
    VideoWriter writer(path, 320, 240, 25);
    uint32_t state = 1;
    for (int i = 0; i < 30; ++i) {
      Image noise(320, 240);
      for (uint8_t& value : noise.bgr)
        state = state * 1664525u + 1013904223u, value = static_cast<uint8_t>(state >> 24);
      writer.Write(noise);
    }
    message = FileErrorOf(path, [&] { writer.Finish(); });
  }
  ::setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_NE(message.find("disk full"), std::string::npos) << message;
  EXPECT_FALSE(fs::exists(path));
  EXPECT_EQ(NumFilesIn(folder.File("")), 0);
}

TEST(Video, RefusesPlacesThatCannotBeWritten) {
  const TemporaryFolder folder;
  const std::string nowhere = folder.File("no/such/folder.mp4"), text = folder.File("clip.txt");
  EXPECT_NE(FileErrorOf(nowhere, [&] { VideoWriter(nowhere, 64, 64, 25); }).find("No such file"), std::string::npos);
  EXPECT_NE(FileErrorOf(text, [&] { VideoWriter(text, 64, 64, 25); }).find("expected .mp4"), std::string::npos);
  EXPECT_THROW(VideoWriter(folder.File("a.mp4"), 0, 64, 25), std::invalid_argument);
  EXPECT_THROW(VideoWriter(folder.File("a.mp4"), 64, 64, 0), std::invalid_argument);
  EXPECT_THROW(VideoWriter(folder.File("a.mp4"), 16384, 16384, 25), std::invalid_argument) << "it could not be read";
  VideoWriter writer(folder.File("a.mp4"), 96, 64, 25);
  EXPECT_THROW(writer.Write(NumberedImage(0, 64, 64)), std::invalid_argument);
}

/// The JPEG with an EXIF segment that asks for a quarter turn to the right (orientation 6).
std::string TurnedByExif(const std::string& jpeg) {
  static constexpr unsigned char kTiff[] = {'I', 'I', '*', 0, 8, 0, 0, 0, 1, 0, 0x12, 1, 3,
                                            0,   1,   0,   0, 0, 6, 0, 0, 0, 0, 0,    0, 0};
  return WithExif(jpeg, std::string(reinterpret_cast<const char*>(kTiff), sizeof kTiff));
}

TEST(Video, AStillImageIsAFolderOfOneAndUpright) {
  const TemporaryFolder folder;
  Image image(64, 32, Colour{255, 255, 255});
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 16; ++x) std::fill_n(image.pixel(x, y), 3, uint8_t{0});  // black on the left
  }
  WriteFileAtomically(folder.File("photo.jpg"), TurnedByExif(EncodeImage(image, "photo.jpg")));
  VideoReader reader(folder.File("photo.jpg"));
  EXPECT_EQ(reader.info().width, 32);
  EXPECT_EQ(reader.info().height, 64);
  EXPECT_EQ(reader.info().num_frames, 1);
  EXPECT_TRUE(std::isnan(reader.frame_time()));
  Image upright;
  ASSERT_TRUE(reader.Read(&upright));
  EXPECT_LT(upright.pixel(16, 5)[0], 40) << "left became up";
  EXPECT_GT(upright.pixel(16, 50)[0], 215);
  EXPECT_FALSE(reader.Read(&upright));
  EXPECT_TRUE(VideoFrameTimes(folder.File("photo.jpg")).empty());
}

TEST(Video, ReadsAFolderOfImagesInTheOrderOfTheirNumbers) {
  const TemporaryFolder folder;
  for (const int i : {0, 1, 2, 9, 10, 11})
    WriteImage(folder.File("frame_" + std::to_string(i) + ".png"), NumberedImage(i));
  WriteFileAtomically(folder.File("notes.txt"), "not an image");
  VideoReader reader(folder.File(""));
  EXPECT_EQ(reader.info().num_frames, 6);
  EXPECT_EQ(reader.info().fps, 0);
  Image frame;
  for (const int i : {0, 1, 2, 9, 10, 11}) {
    ASSERT_TRUE(reader.Read(&frame));
    EXPECT_EQ(frame, NumberedImage(i)) << "frame " << i;  // PNG keeps every bit
  }
  EXPECT_FALSE(reader.Read(&frame));
}

TEST(Video, AFolderHasNoClock) {
  const TemporaryFolder folder;
  for (int i = 0; i < 5; ++i) WriteImage(folder.File(std::to_string(i) + ".png"), NumberedImage(i));
  VideoReader reader(folder.File(""));
  EXPECT_EQ(reader.Skip(3), 3);
  Image frame;
  ASSERT_TRUE(reader.Read(&frame));
  EXPECT_EQ(NumberOf(frame), 3);
  EXPECT_TRUE(std::isnan(reader.frame_time()));
  EXPECT_NE(FileErrorOf(folder.File(""), [&] { reader.SkipTo(1); }).find("no clock"), std::string::npos);
  EXPECT_EQ(reader.Skip(9), 1);
  EXPECT_FALSE(reader.Read(&frame));
  EXPECT_EQ(reader.warning(), "");
  EXPECT_TRUE(VideoFrameTimes(folder.File("")).empty());
}

TEST(Video, FoldersWithFaultsNameTheFile) {
  const TemporaryFolder folder;
  fs::create_directory(folder.File("empty"));
  FileErrorOf(folder.File("empty"), [&] { VideoReader reader(folder.File("empty")); });
  WriteImage(folder.File("a1.png"), NumberedImage(1));
  WriteImage(folder.File("a2.png"), NumberedImage(2, 64, 64));
  VideoReader reader(folder.File(""));
  Image frame;
  ASSERT_TRUE(reader.Read(&frame));
  EXPECT_NE(FileErrorOf("a2.png", [&] { reader.Read(&frame); }).find("64x64"), std::string::npos);
}

TEST(ImageFile, KeepsEveryPixelAsPng) {
  const TemporaryFolder folder;
  WriteImage(folder.File("a.png"), NumberedImage(3));
  EXPECT_EQ(ReadImage(folder.File("a.png")), NumberedImage(3));
  WriteImage(folder.File("a.jpg"), NumberedImage(3));
  EXPECT_EQ(NumberOf(ReadImage(folder.File("a.jpg"))), 3);
  EXPECT_THROW(WriteImage(folder.File("a.png"), Image()), std::invalid_argument);
  FileErrorOf("a.gif", [&] { WriteImage(folder.File("a.gif"), NumberedImage(3)); });
}

TEST(ImageFile, TruncatedImagesAreRefusedOrShowWhatIsThere) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.png"), cut = folder.File("cut.png");
  WriteImage(path, NumberedImage(3));
  const std::string bytes = ReadFileBytes(path);
  int refused = 0;
  for (size_t size = 0; size < bytes.size(); size += 7) {
    WriteFileAtomically(cut, bytes.substr(0, size));
    try {
      const Image image = ReadImage(cut);
      EXPECT_EQ(image.width, 96);  // OpenCV hands out the rows it could decode
    } catch (const std::runtime_error& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find(cut), std::string::npos);
    }
  }
  EXPECT_GT(refused, 5);
  std::string lying = bytes;
  lying[16] = '\x7f';  // a width of two billion pixels
  WriteFileAtomically(cut, lying);
  FileErrorOf(cut, [&] { ReadImage(cut); });
}

TEST(Video, ReadsARealPhoneVideo) {
  const std::string path = SharedDir() + "/data/tfjs_pose/pose_squats.mp4";
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not here";
  VideoReader reader(path);
  EXPECT_NEAR(reader.info().fps, 5, 1e-6);
  EXPECT_EQ(reader.Skip(1000), 65);
}

}  // namespace
}  // namespace bodyloom::video_test
