// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/data_tools/video/video_reader.h"
#include "bodyloom/data_tools/video/video_writer.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

/// A picture that says which frame it is: a bright bar at column 4·index on a soft ramp.
Image Picture(int index, int width = 96, int height = 64) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool bar = x / 4 == index;
      uint8_t* p = image.pixel(x, y);
      p[0] = bar ? 250 : 40 + y;
      p[1] = bar ? 250 : 60 + x / 2;
      p[2] = bar ? 250 : 50;
    }
  }
  return image;
}

int BarOf(const Image& image) {
  int best = -1, brightest = 180;
  for (int k = 0; k < image.width / 4; ++k) {
    const Colour c = image.at(4 * k + 2, image.height / 2);
    const int least = std::min({c.red, c.green, c.blue});
    if (least > brightest) brightest = least, best = k;
  }
  return best;
}

void WriteClip(const std::string& path, int frames, int width = 96, int height = 64, double fps = 25) {
  VideoWriter writer(path, width, height, fps);
  for (int i = 0; i < frames; ++i) writer.Write(Picture(i, width, height));
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
    EXPECT_EQ(BarOf(frame), i);
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
  EXPECT_EQ(BarOf(frame), 0);
}

TEST(Video, SameFramesGiveTheSameBytes) {
  const TemporaryFolder folder;
  WriteClip(folder.File("a.mp4"), 12);
  WriteClip(folder.File("b.mp4"), 12);
  EXPECT_EQ(ReadFileBytes(folder.File("a.mp4")), ReadFileBytes(folder.File("b.mp4")));
}

TEST(Video, SkipsFrames) {
  const TemporaryFolder folder;
  const std::string path = folder.File("clip.mp4");
  WriteClip(path, 10);
  VideoReader reader(path);
  EXPECT_EQ(reader.Skip(7), 7);
  Image frame;
  ASSERT_TRUE(reader.Read(&frame));
  EXPECT_EQ(BarOf(frame), 7);
  EXPECT_EQ(reader.Skip(100), 2);
}

TEST(Video, UnfinishedFileDoesNotAppear) {
  const TemporaryFolder folder;
  {
    VideoWriter writer(folder.File("clip.mp4"), 96, 64, 25);
    for (int i = 0; i < 5; ++i) writer.Write(Picture(i));
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
  VideoWriter writer(folder.File("a.mp4"), 96, 64, 25);
  EXPECT_THROW(writer.Write(Picture(0, 64, 64)), std::invalid_argument);
}

TEST(Video, RefusesWhatIsNoVideo) {
  const TemporaryFolder folder;
  const std::string missing = folder.File("missing.mp4"), empty = folder.File("empty.mp4"),
                    text = folder.File("text.mp4");
  WriteFileAtomically(empty, "");
  WriteFileAtomically(text, std::string(5000, 'x'));
  EXPECT_NE(FileErrorOf(missing, [&] { VideoReader reader(missing); }).find("no such"), std::string::npos);
  EXPECT_NE(FileErrorOf(empty, [&] { VideoReader reader(empty); }).find("empty"), std::string::npos);
  FileErrorOf(text, [&] { VideoReader reader(text); });
}

TEST(Video, CutOffVideosAreReportedWhereverTheyEnd) {
  const TemporaryFolder folder;
  const std::string path = folder.File("clip.mp4"), cut = folder.File("cut.mp4");
  WriteClip(path, 24);
  const std::string bytes = ReadFileBytes(path);
  testing::internal::CaptureStderr();
  int refused = 0, tried = 0;
  for (size_t size = 1; size < bytes.size(); size += bytes.size() / 40 + 1, ++tried) {
    WriteFileAtomically(cut, bytes.substr(0, size));
    try {
      VideoReader reader(cut);
      EXPECT_EQ(reader.Skip(100), 24) << size << " of " << bytes.size()
                                      << " bytes";  // only notes behind the frames are gone
    } catch (const std::runtime_error& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find(cut), std::string::npos) << error.what();
    }
  }
  EXPECT_GT(refused, tried - 4);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "libraries do not print";
}

TEST(Video, DamagedVideosNeverCrash) {
  const TemporaryFolder folder;
  const std::string path = folder.File("clip.mp4"), damaged = folder.File("damaged.mp4");
  WriteClip(path, 12);
  const std::string bytes = ReadFileBytes(path);
  uint32_t state = 7;
  for (int round = 0; round < 40; ++round) {
    std::string copy = bytes;
    for (int k = 0; k < 20; ++k) {
      state = state * 1664525u + 1013904223u;
      copy[state % copy.size()] = static_cast<char>(state >> 24);
    }
    WriteFileAtomically(damaged, copy);
    try {
      VideoReader reader(damaged);
      Image frame;
      int frames = 0;
      while (frames < 200 && reader.Read(&frame)) ++frames;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(damaged), std::string::npos);
    }
  }
}

TEST(Video, ReadsAFolderOfImagesInTheOrderOfTheirNumbers) {
  const TemporaryFolder folder;
  for (const int i : {0, 1, 2, 9, 10, 11}) WriteImage(folder.File("frame_" + std::to_string(i) + ".png"), Picture(i));
  WriteFileAtomically(folder.File("notes.txt"), "not an image");
  VideoReader reader(folder.File(""));
  EXPECT_EQ(reader.info().num_frames, 6);
  EXPECT_EQ(reader.info().fps, 0);
  Image frame;
  for (const int i : {0, 1, 2, 9, 10, 11}) {
    ASSERT_TRUE(reader.Read(&frame));
    EXPECT_EQ(frame, Picture(i)) << "frame " << i;  // PNG keeps every bit
  }
  EXPECT_FALSE(reader.Read(&frame));
}

TEST(Video, FoldersWithFaultsNameTheFile) {
  const TemporaryFolder folder;
  fs::create_directory(folder.File("empty"));
  FileErrorOf(folder.File("empty"), [&] { VideoReader reader(folder.File("empty")); });
  WriteImage(folder.File("a1.png"), Picture(1));
  WriteImage(folder.File("a2.png"), Picture(2, 64, 64));
  VideoReader reader(folder.File(""));
  Image frame;
  ASSERT_TRUE(reader.Read(&frame));
  EXPECT_NE(FileErrorOf("a2.png", [&] { reader.Read(&frame); }).find("64x64"), std::string::npos);
}

TEST(ImageFile, KeepsEveryPixelAsPng) {
  const TemporaryFolder folder;
  WriteImage(folder.File("a.png"), Picture(3));
  EXPECT_EQ(ReadImage(folder.File("a.png")), Picture(3));
  WriteImage(folder.File("a.jpg"), Picture(3));
  EXPECT_EQ(BarOf(ReadImage(folder.File("a.jpg"))), 3);
  EXPECT_THROW(WriteImage(folder.File("a.png"), Image()), std::invalid_argument);
  FileErrorOf("a.gif", [&] { WriteImage(folder.File("a.gif"), Picture(3)); });
}

TEST(ImageFile, TruncatedImagesAreRefusedOrShowWhatIsThere) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.png"), cut = folder.File("cut.png");
  WriteImage(path, Picture(3));
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
  const std::string path = std::string(BODYLOOM_SHARED_DIR) + "/data/tfjs_pose/pose_squats.mp4";
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not here";
  VideoReader reader(path);
  EXPECT_NEAR(reader.info().fps, 5, 1e-6);
  EXPECT_EQ(reader.Skip(1000), 65);
}

}  // namespace
}  // namespace bodyloom
