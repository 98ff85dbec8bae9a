// SPDX-License-Identifier: Apache-2.0
// Timestamps of frames, read with them and from packets alone, and seeking by frame number and by time.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/video_reader.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/data_tools/video/clip_maker.h"

namespace bodyloom::video_times_test {
namespace {

constexpr int kFrames = 24;
const std::string kBFrames = "-c:v libx264 -pix_fmt yuv420p -qp 10 -bf 3 -x264-params b-adapt=0 ";

std::vector<int> Numbers(int first, int end) {
  std::vector<int> numbers(std::max(0, end - first));
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

std::vector<double> Even(int frames, double fps) {
  std::vector<double> times(frames);
  for (int i = 0; i < frames; ++i) times[i] = i / fps;
  return times;
}

/// The clip holds these pictures and shows them at these times; packets tell the same times as frames.
void ExpectClip(const std::string& path, const std::vector<int>& numbers, const std::vector<double>& times,
                double tolerance = 1e-9) {
  const ReadClip clip = ReadAll(path);
  EXPECT_EQ(clip.numbers, numbers) << path;
  EXPECT_EQ(clip.warning, "");
  ASSERT_EQ(clip.times.size(), times.size()) << path;
  for (size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(clip.times[i], times[i], tolerance) << path << ", frame " << i;
  EXPECT_EQ(VideoFrameTimes(path), clip.times) << path;
}

/// Time of frame i in a phone's nominal 59.94 frames per second: late by up to three quarters of a frame.
double PhoneTime(int i) { return (1001.0 * i + 250 * (7 * i % 4)) / 60000; }

std::string PhoneClip(const TemporaryFolder& folder) {
  const std::string encoded = folder.File("encoded.mp4");
  std::string phone = folder.File("phone.mov");
  Ffmpeg(NumberedInput(folder, kFrames, "60000/1001") +
         "-vf 'settb=1/60000,setpts=N*1001+250*mod(7*N\\,4)' -vsync passthrough -enc_time_base 1/60000 " + kBFrames +
         "-video_track_timescale 60000 " + encoded);
  WriteTurned(ReadFileBytes(encoded), {0, 1, -1, 0}, phone);  // held upright: a quarter turn clockwise to be shown
  return phone;
}

TEST(VideoTimes, APhonesClip) {
  const TemporaryFolder folder;
  const std::string path = PhoneClip(folder);
  VideoReader reader(path);
  EXPECT_EQ(reader.info().width, 64);
  EXPECT_EQ(reader.info().height, 96);
  EXPECT_EQ(reader.info().num_frames, kFrames);
  EXPECT_NEAR(reader.info().fps, 59.94, 4) << "the mean of 24 frames, of which the last one's duration is a guess";
  EXPECT_EQ(reader.frame_time(), 0);
  Image frame;
  std::vector<double> times;
  for (int i = 0; i < kFrames; ++i) {
    ASSERT_TRUE(reader.Read(&frame));
    times.push_back(reader.frame_time());
    EXPECT_NEAR(times.back(), PhoneTime(i), 1e-12) << "frame " << i;
    const Colour bar = frame.at(32, 4 * i + 2), beside = frame.at(32, (4 * i + 50) % 96);
    EXPECT_GT(std::min({bar.red, bar.green, bar.blue}), 200) << "frame " << i;
    EXPECT_LT(beside.red, 90) << "frame " << i;
  }
  EXPECT_FALSE(reader.Read(&frame));
  EXPECT_EQ(reader.warning(), "");
  EXPECT_EQ(VideoFrameTimes(path), times);
}

TEST(VideoTimes, OrderOfBFrames) {
  const TemporaryFolder folder;
  const std::string input = NumberedInput(folder, kFrames);
  for (const std::string name : {"clip.mp4", "clip.avi", "clip.ts", "clip.h264"}) {
    Ffmpeg(input + kBFrames + folder.File(name));
    ExpectClip(folder.File(name), Numbers(0, kFrames), Even(kFrames, 30));
  }
  Ffmpeg(input + kBFrames + folder.File("clip.mkv"));  // milliseconds
  ExpectClip(folder.File("clip.mkv"), Numbers(0, kFrames), Even(kFrames, 30), 1.001e-3);
}

TEST(VideoTimes, EncodersAndContainers) {
  const TemporaryFolder folder;
  const std::string input = NumberedInput(folder, kFrames, "25");
  for (const std::string coded :
       {"-c:v libx265 -x265-params log-level=none -pix_fmt yuv420p10 -crf 10 a.mp4", "-c:v mpeg4 -q:v 2 -bf 2 b.mp4",
        "-c:v mpeg2video -q:v 2 -bf 2 c.ts", "-c:v libvpx -auto-alt-ref 1 -lag-in-frames 16 -b:v 2M d.webm",
        "-c:v libvpx-vp9 -auto-alt-ref 1 -lag-in-frames 16 -b:v 2M e.webm", "-c:v prores f.mov",
        "-c:v libx264 -qp 10 -flags +ildct+ilme -pix_fmt yuv420p g.ts",
        "-c:v libx264 -qp 10 -movflags frag_keyframe+empty_moov -pix_fmt yuv420p h.mp4"}) {
    const size_t name = coded.rfind(' ') + 1;
    const std::string path = folder.File(coded.substr(name));
    Ffmpeg(input + coded.substr(0, name) + path);
    ExpectClip(path, Numbers(0, kFrames), Even(kFrames, 25), 1e-9);
    EXPECT_NEAR(VideoReader(path).info().fps, 25, 1e-9) << path;
  }
}

TEST(VideoTimes, FramesThatAnEditListHidesAreNotThere) {
  const TemporaryFolder folder;
  const std::string whole = folder.File("whole.mp4"), cut = folder.File("cut.mp4");
  Ffmpeg(NumberedInput(folder, kFrames) + kBFrames + "-g 8 " + whole);
  Ffmpeg("-ss 0.36 -i " + whole + " -c copy " + cut);  // from the key frame before, hidden up to frame 11
  ExpectClip(cut, Numbers(11, kFrames), Even(kFrames - 11, 30), 1e-9);
  EXPECT_EQ(VideoReader(cut).info().num_frames, kFrames - 11);
}

TEST(VideoTimes, BeginningsWithoutTheirKeyFrame) {
  const TemporaryFolder folder;
  const std::string whole = folder.File("whole.ts"), cut = folder.File("cut.ts");
  Ffmpeg(NumberedInput(folder, kFrames) + kBFrames + "-g 8 " + whole);
  const std::string bytes = ReadFileBytes(whole);
  int shorter = 0;
  for (size_t packets = 10; packets < 60; packets += 10) {
    WriteFileAtomically(cut, bytes.substr(188 * packets));
    ReadClip clip;
    try {
      clip = ReadAll(cut);
    } catch (const std::runtime_error&) {
      continue;
    }
    EXPECT_EQ(VideoFrameTimes(cut), clip.times) << packets << " packets cut away";
    shorter += clip.times.size() < kFrames;
  }
  EXPECT_GT(shorter, 0);
}

TEST(VideoTimes, RecordingsPutOneBehindTheOther) {
  const TemporaryFolder folder;
  const std::string one = folder.File("one.ts"), both = folder.File("both.ts");
  Ffmpeg(NumberedInput(folder, kFrames, "10") + kBFrames + one);
  WriteFileAtomically(both, ReadFileBytes(one) + ReadFileBytes(one));
  const ReadClip clip = ReadAll(both);
  EXPECT_EQ(clip.times.size(), size_t{2 * kFrames});
  for (size_t i = 1; i < clip.times.size(); ++i) EXPECT_GT(clip.times[i], clip.times[i - 1]) << "frame " << i;
  EXPECT_NEAR(clip.times.back(), (2 * kFrames - 1) / 10.0, 0.2);
  EXPECT_EQ(VideoFrameTimes(both), clip.times);
}

TEST(VideoTimes, FrameRates) {
  const TemporaryFolder folder;
  const std::pair<std::string, double> rates[] = {
      {"24000/1001", 24 / 1.001}, {"30000/1001", 30 / 1.001}, {"60000/1001", 60 / 1.001}, {"240", 240}, {"1/2", 0.5}};
  for (const auto& [rate, fps] : rates) {
    for (const std::string name : {"clip.mp4", "clip.mkv"}) {
      Ffmpeg(NumberedInput(folder, kFrames, rate) + kBFrames + folder.File(name));
      EXPECT_NEAR(VideoReader(folder.File(name)).info().fps, fps, 1e-3 * fps) << rate << " " << name;
    }
  }
  // Half of the frames come at 60 a second, half at 20.
  Ffmpeg(NumberedInput(folder, kFrames) +
         "-vf 'settb=1/600,setpts=if(lt(N\\,12)\\,10*N\\,120+30*(N-12))' -vsync passthrough -enc_time_base 1/600 " +
         kBFrames + folder.File("varying.mp4"));
  // (24 frames in 0.75 s; the last one's own duration is not known to the encoder.)
  EXPECT_NEAR(VideoReader(folder.File("varying.mp4")).info().fps, 24 / 0.75, 2);
}

TEST(VideoTimes, SkipGoesToTheSameFrames) {
  const TemporaryFolder folder;
  const std::string path = folder.File("clip.mp4");
  Ffmpeg(NumberedInput(folder, kFrames) + kBFrames + path);
  for (int first = 0; first < kFrames; first += 5) {
    VideoReader reader(path);
    EXPECT_EQ(reader.Skip(first), first);
    EXPECT_EQ(reader.next_frame(), first);
    EXPECT_NEAR(reader.frame_time(), std::max(0, first - 1) / 30.0, 1e-9);
    Image frame;
    ASSERT_TRUE(reader.Read(&frame));
    EXPECT_EQ(NumberOf(frame), first);
    EXPECT_EQ(reader.Skip(0), 0);
    EXPECT_EQ(reader.Skip(-3), 0);
    EXPECT_EQ(reader.Skip(1000), kFrames - first - 1);
    EXPECT_FALSE(reader.Read(&frame));
  }
}

TEST(VideoTimes, SkipToATime) {
  const TemporaryFolder folder;
  const std::string path = PhoneClip(folder);
  for (int i = 0; i < kFrames; ++i) {
    for (const double early : {0.0, 0.003}) {
      VideoReader reader(path);
      EXPECT_EQ(reader.SkipTo(PhoneTime(i) - early), i);
      EXPECT_EQ(reader.next_frame(), i);
      EXPECT_EQ(reader.SkipTo(PhoneTime(i) - early), 0);
      Image frame;
      ASSERT_TRUE(reader.Read(&frame));
      EXPECT_NEAR(reader.frame_time(), PhoneTime(i), 1e-12);
      EXPECT_GT(frame.at(32, 4 * i + 2).red, 200);
    }
  }
  VideoReader reader(path);
  EXPECT_EQ(reader.SkipTo(-5), 0);
  EXPECT_EQ(reader.SkipTo(1e9), kFrames);
  Image frame;
  EXPECT_FALSE(reader.Read(&frame));
  EXPECT_EQ(reader.warning(), "");
}

}  // namespace
}  // namespace bodyloom::video_times_test
