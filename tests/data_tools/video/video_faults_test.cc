// SPDX-License-Identifier: Apache-2.0
// Truncated, damaged and non-video files: frames up to the last complete one, or one line that names the file.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/video_reader.h"
#include "data_tools/video/video_writer.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/data_tools/video/clip_maker.h"
#include "tests/fuzz/run_mutations.h"

namespace bodyloom::video_faults_test {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;

std::string OpeningError(const std::string& path) {
  std::string message = FileErrorOf(path, [&] { VideoReader reader(path); });
  EXPECT_EQ(message, FileErrorOf(path, [&] { VideoFrameTimes(path); }));
  return message;
}

void ExpectError(const std::string& path, const std::string& text) {
  const std::string message = OpeningError(path);
  EXPECT_NE(message.find(text), std::string::npos) << message;
}

void ExpectLibrariesSilent(const std::function<void()>& action) {
  testing::internal::CaptureStderr();
  action();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(VideoFaults, RefusesWhatIsNoVideo) {
  const TemporaryFolder folder;
  const std::string empty = folder.File("empty.mp4"), text = folder.File("text.mp4"), notes = folder.File("notes.txt"),
                    list = folder.File("list.mp4");
  std::string lines;
  WriteFileAtomically(empty, "");
  WriteFileAtomically(text, std::string(5000, 'x'));
  for (int i = 0; i < 1000; ++i) lines += "what was seen\n";
  WriteFileAtomically(notes, lines);
  WriteFileAtomically(list, "#EXTM3U\n#EXTINF:5,\nhttp://127.0.0.1:9/clip.ts\n#EXT-X-ENDLIST\n");
  ExpectError(folder.File("missing.mp4"), "no such");
  ExpectError(empty, "empty");
  ExpectError(text, "not a video");
  ExpectError(notes, "a text, expected a video");
  OpeningError(list);
  ExpectError("/dev/null", "neither a regular file");
  fs::create_directory(folder.File("folder.mp4"));
  FileErrorOf("folder.mp4", [&] { VideoReader reader(folder.File("folder.mp4")); });
}

TEST(VideoFaults, SoundIsNoVideo) {
  const TemporaryFolder folder;
  const std::string sound = folder.File("sound.m4a"), wave = folder.File("sound.wav"), cover = folder.File("cover.m4a");
  Ffmpeg("-f lavfi -i sine=duration=0.2 " + sound);
  Ffmpeg("-f lavfi -i sine=duration=0.2 " + wave);
  WriteImage(folder.File("cover.png"), NumberedImage(1));
  Ffmpeg("-i " + sound + " -i " + folder.File("cover.png") +
         " -map 0 -map 1 -c:a copy -c:v png -disposition:v:0 attached_pic " + cover);
  for (const std::string& path : {sound, wave, cover}) ExpectError(path, "sound without a video stream");
}

TEST(VideoFaults, AVideoAmongOtherStreamsIsFound) {
  const TemporaryFolder folder;
  const std::string path = folder.File("clip.mkv");
  Ffmpeg(NumberedInput(folder, 10) + "-f lavfi -i sine=duration=3 -map 1 -map 0 -c:a aac -c:v libx264 -qp 10 " + path);
  const ReadClip clip = ReadAll(path);
  EXPECT_EQ(clip.numbers, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(clip.warning, "") << "sound may last longer";
}

TEST(VideoFaults, HugeImagesAreRefusedBeforeMemoryIsTaken) {
  const TemporaryFolder folder;
  const std::string clip = folder.File("clip.mp4"), huge = folder.File("huge.mp4");
  Ffmpeg(NumberedInput(folder, 3) + "-c:v libx264 -pix_fmt yuv420p " + clip);
  std::string bytes = ReadFileBytes(clip);
  const size_t entry = bytes.find("avc1", bytes.find("stsd"));
  ASSERT_NE(entry, std::string::npos);
  bytes.replace(entry + 28, 4, "\xF0\x00\xF0\x00"s);
  WriteFileAtomically(huge, bytes);
  ExpectError(huge, "61440x61440 pixels, expected at most 67108864");
}

/// Cut anywhere: the frames before the cut come out as they are in the whole clip, and the warning says that it is cut.
void ExpectWholeFrames(const std::string& bytes, const std::string& cut, int frames, bool promises) {
  int opened = 0, warned = 0;
  size_t maximum = 0;
  for (size_t size = 1; size < bytes.size(); size += bytes.size() / 60 + 1) {
    WriteFileAtomically(cut, bytes.substr(0, size));
    try {
      const ReadClip clip = ReadAll(cut);
      ++opened;
      EXPECT_GE(clip.times.size(), maximum) << "the longer the file, the more frames";
      maximum = std::max(maximum, clip.times.size());
      for (size_t i = 0; i < clip.numbers.size(); ++i) EXPECT_EQ(clip.numbers[i], static_cast<int>(i));
      EXPECT_EQ(VideoFrameTimes(cut), clip.times) << size << " bytes";
      if (static_cast<int>(clip.times.size()) == frames) continue;
      warned += !clip.warning.empty();
      if (promises) {
        EXPECT_NE(clip.warning.find(cut + ": cut off or damaged after " + std::to_string(clip.times.size())),
                  std::string::npos)
            << clip.warning;
      }
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(cut), std::string::npos) << error.what();
      EXPECT_EQ(maximum, 0U) << "a longer file is refused: " << error.what();
    }
  }
  EXPECT_GT(opened, 20);
  EXPECT_GT(warned, 10);
}

TEST(VideoFaults, FilesThatAreCutOffAreReadToTheirLastWholeFrame) {
  const TemporaryFolder folder;
  constexpr int kFrames = 20;
  const std::string input = NumberedInput(folder, kFrames);
  struct Case {
    std::string name, options;
    bool promises;
  };
  ExpectLibrariesSilent([&] {
    for (const Case& c :
         {Case{"a.mp4", "-c:v libx264 -pix_fmt yuv420p -qp 4 -bf 0 -movflags +faststart", true},
          Case{"b.avi", "-c:v mjpeg -q:v 2", true}, Case{"c.mov", "-c:v prores -movflags +faststart", true},
          Case{"d.mp4", "-c:v libx264 -pix_fmt yuv420p -qp 4 -bf 0 -g 1 -movflags frag_keyframe+empty_moov", false}}) {
      const std::string path = folder.File(c.name);
      Ffmpeg(input + c.options + " " + path);
      ExpectWholeFrames(ReadFileBytes(path), folder.File("cut_" + c.name), kFrames, c.promises);
    }
  });
}

TEST(VideoFaults, MatroskaSaysHowLongItShouldHaveBeen) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.mkv"), cut = folder.File("cut.mkv");
  Ffmpeg(NumberedInput(folder, 20, "10") + "-c:v libx264 -qp 4 -g 1 " + path);
  const std::string bytes = ReadFileBytes(path);
  EXPECT_EQ(ReadAll(path).warning, "");
  WriteFileAtomically(cut, bytes.substr(0, bytes.size() / 2));
  const ReadClip clip = ReadAll(cut);
  EXPECT_GT(clip.times.size(), 3U);
  EXPECT_NE(clip.warning.find("it promises 2 s"), std::string::npos) << clip.warning;
}

TEST(VideoFaults, ARecordingThatWasInterruptedHasNoIndex) {
  const TemporaryFolder folder;
  const std::string path = folder.File("clip.mp4"), cut = folder.File("cut.mp4");
  Ffmpeg(NumberedInput(folder, 24) + "-c:v libx264 -pix_fmt yuv420p " + path);
  const std::string bytes = ReadFileBytes(path);
  ExpectLibrariesSilent([&] {
    for (size_t size = 8; size < bytes.find("moov"); size += bytes.size() / 40 + 1) {
      WriteFileAtomically(cut, bytes.substr(0, size));
      ExpectError(cut, "without a readable index");
    }
  });
}

TEST(VideoFaults, FramesThatCannotBeDecodedAreLeftOutAndCounted) {
  const TemporaryFolder folder;
  const std::string path = folder.File("clip.mov"), damaged = folder.File("damaged.mov");
  Ffmpeg(NumberedInput(folder, 12) + "-c:v png " + path);
  std::string bytes = ReadFileBytes(path);
  for (const int frame : {7, 3}) {  // the last first: what is gone is not counted again
    size_t at = 0;
    for (int i = 0; i <= frame; ++i) at = bytes.find("\x89PNG", at + 1);
    ASSERT_NE(at, std::string::npos);
    bytes.replace(at, 4, "gone");
  }
  WriteFileAtomically(damaged, bytes);
  const ReadClip clip = ReadAll(damaged);
  EXPECT_EQ(clip.numbers, (std::vector<int>{0, 1, 2, 4, 5, 6, 8, 9, 10, 11}));
  EXPECT_NEAR(clip.times[3], 4 / 30.0, 1e-9) << "the others stay at their times";
  EXPECT_NE(clip.warning.find("2 frames cannot be decoded"), std::string::npos) << clip.warning;
}

/// Returns true if a damaged file gives frames of one size at ascending times, or a one-line error.
bool Holds(const std::string& path) {
  try {
    VideoReader reader(path);
    EXPECT_GE(reader.info().fps, 0);
    Image frame;
    double last = -1;
    for (int i = 0; i < 100 && reader.Read(&frame); ++i) {
      EXPECT_EQ(frame.width, reader.info().width);
      EXPECT_EQ(frame.height, reader.info().height);
      EXPECT_GT(reader.frame_time(), last);
      last = reader.frame_time();
    }
    EXPECT_EQ(reader.warning().find('\n'), std::string::npos);
    VideoFrameTimes(path);
    return true;
  } catch (const std::runtime_error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(path), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return false;
  }
}

TEST(VideoFaults, DamagedFilesNeverCrash) {
  const TemporaryFolder folder;
  const std::string input = NumberedInput(folder, 4, "30", 32, 32), path = folder.File("damaged");
  std::vector<std::string> seeds;
  for (const std::string coded : {"-c:v libx264 -pix_fmt yuv420p a.mp4", "-c:v mpeg4 b.mp4", "-c:v libvpx c.webm",
                                  "-c:v ffv1 d.mkv", "-c:v mjpeg e.avi", "-c:v mpeg2video f.ts", "-c:v gif g.gif"}) {
    const size_t name = coded.rfind(' ') + 1;
    Ffmpeg(input + coded.substr(0, name) + folder.File(coded.substr(name)));
    seeds.push_back(ReadFileBytes(folder.File(coded.substr(name))));
  }
  constexpr int kMutations = 500;
  int held = 0;
  ExpectLibrariesSilent([&] {
    fuzz::Mutator mutator(seeds);
    for (int i = 0; i < kMutations; ++i) {
      WriteFileAtomically(path, mutator.Next());
      held += Holds(path);
    }
  });
  EXPECT_GT(held, kMutations / 20);
  EXPECT_LT(held, kMutations - kMutations / 20);
}

TEST(VideoFaults, GarbageOfEveryKindNeverCrashes) {
  const TemporaryFolder folder;
  const std::string path = folder.File("garbage");
  const std::string beginnings[] = {"",
                                    "\0\0\0\x18"
                                    "ftypisom"s,
                                    "\x1A\x45\xDF\xA3"s,
                                    "RIFF\xFF\xFF\0\0AVI LIST"s,
                                    "\x47\x40\0\x10"s,
                                    "\0\0\1\xBA"s,
                                    "\0\0\0\1\x67"s,
                                    "FLV\1\5\0\0\0\x09"s,
                                    "OggS\0\2"s,
                                    "GIF89a"s,
                                    "\x30\x26\xB2\x75\x8E\x66\xCF\x11"s,
                                    "ffconcat version 1.0\nfile /etc/passwd\n"s,
                                    "#EXTM3U\n"s,
                                    "YUV4MPEG2 W100000 H100000 F25:1\nFRAME\n"s,
                                    "\x89PNG\r\n\x1a\n"s};
  std::mt19937 random(11);
  ExpectLibrariesSilent([&] {
    for (const std::string& beginning : beginnings) {
      for (int k = 0; k < 12; ++k) {
        std::string bytes = beginning;
        for (size_t i = random() % 3000; i > 0; --i) bytes += static_cast<char>(k % 3 == 0 ? 0 : random());
        WriteFileAtomically(path, bytes.empty() ? "x" : bytes);
        Holds(path);
      }
    }
  });
}

}  // namespace
}  // namespace bodyloom::video_faults_test
