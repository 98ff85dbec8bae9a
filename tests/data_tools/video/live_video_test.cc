// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/live_video.h"

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <thread>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/video_reader.h"
#include "tests/data_tools/video/clip_maker.h"
#include "tests/data_tools/video/tcp_source.h"

namespace bodyloom::live_video_test {
namespace {

using Event = LiveVideo::Event;

LiveVideoOptions WithoutWaiting() {
  LiveVideoOptions options;
  options.pace = 0;
  return options;
}

/// A clip of numbered images in a folder of its own.
class NumberedClip {
 public:
  NumberedClip(int frames, const std::string& coding, const std::string& name) : path_(folder_.File(name)) {
    Ffmpeg(NumberedInput(folder_, frames) + coding + " " + path_);
  }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  TemporaryFolder folder_;
  std::string path_;
};

TEST(FramePace, OfAFileIsItsFirstFrames) {
  FramePace pace(true);
  pace.Restart(0, 100);
  EXPECT_EQ(pace.Due(1.5), 101.5);
  EXPECT_FALSE(pace.IsLate(1, 101));
  EXPECT_FALSE(pace.IsLate(3, 101.5));  // decoded ahead
  EXPECT_FALSE(pace.IsLate(3.5, 103.69));
  EXPECT_TRUE(pace.IsLate(4, 104.21));
  EXPECT_EQ(pace.Due(4), 104);  // it catches up
  EXPECT_FALSE(pace.IsLate(5, 105));
}

TEST(FramePace, OfASenderIsByTheLeastDelay) {
  FramePace pace(false);
  pace.Restart(50, 100);  // the first frame had waited for a second
  EXPECT_FALSE(pace.IsLate(51, 100));
  EXPECT_TRUE(pace.IsLate(52, 101.25));
  EXPECT_FALSE(pace.IsLate(53, 102.1));
  // A clock that is slower by half a thousandth is followed for hours.
  for (int i = 0; i < 20'000; ++i) EXPECT_FALSE(pace.IsLate(54 + i, 103 + i * 1.0005)) << i;
}

TEST(FramePace, GoesOnFromASourceThatStoodStill) {
  for (const bool is_file : {true, false}) {
    FramePace pace(is_file);
    pace.Restart(0, 0);
    EXPECT_FALSE(pace.IsLate(1, 1));
    // Nothing for four minutes, then frames at the usual pace: all are late by as much.
    EXPECT_FALSE(pace.IsLate(1.1, 241));
    EXPECT_FALSE(pace.IsLate(1.2, 241.1));
    EXPECT_NEAR(pace.Due(1.2), 241.1, 0.25);
    // Half a second of silence: two seconds are passed over in the hope that it catches up.
    int late = 0;
    for (int i = 0; i < 40; ++i) late += pace.IsLate(1.3 + 0.1 * i, 241.7 + 0.1 * i) ? 1 : 0;
    EXPECT_NEAR(late, 15, 1);
  }
}

TEST(LiveVideo, TellsSourcesByTheirNames) {
  EXPECT_EQ(LiveSourceKindOf("/dev/video0"), LiveSourceKind::kCamera);
  EXPECT_EQ(LiveSourceKindOf("/dev/null"), LiveSourceKind::kCamera);  // a device
  EXPECT_EQ(LiveSourceKindOf("/dev/shm/clip.mp4"), LiveSourceKind::kFile);
  EXPECT_EQ(LiveSourceKindOf("rtsp://phone.local:8554/live"), LiveSourceKind::kStream);
  EXPECT_EQ(LiveSourceKindOf("clip.mp4"), LiveSourceKind::kFile);
  EXPECT_EQ(LiveSourceKindOf("a:b.mp4"), LiveSourceKind::kFile);
}

TEST(LiveVideo, GivesTheFramesOfAFileAtTheirTimes) {
  const NumberedClip clip(20, "-c:v mpeg4", "clip.mp4");
  VideoReader reader(clip.path());
  LiveVideo live(clip.path(), WithoutWaiting());
  LiveImage frame;
  Image expected;
  int frames = 0;
  while (live.Read(&frame) == Event::kFrame) {
    ASSERT_TRUE(reader.Read(&expected));
    EXPECT_EQ(frame.image, expected) << frames;
    EXPECT_EQ(frame.seconds, reader.frame_time()) << frames;
    ++frames;
  }
  EXPECT_FALSE(reader.Read(&expected));
  EXPECT_EQ(frames, 20);
  EXPECT_EQ(live.late(), 0);
  EXPECT_EQ(live.Read(&frame), Event::kEnd);
}

TEST(LiveVideo, AFileArrivesAtItsOwnPace) {
  const NumberedClip clip(12, "-c:v mpeg4", "clip.mp4");
  LiveVideoOptions options;
  options.pace = 2;
  LiveVideo live(clip.path(), options);
  LiveImage frame;
  std::optional<LiveImage::Clock::time_point> first;
  while (live.Read(&frame) == Event::kFrame) {
    if (!first) first = frame.arrived;
    EXPECT_NEAR(std::chrono::duration<double>(frame.arrived - *first).count(), frame.seconds / 2, 1e-6);
    EXPECT_GE(LiveImage::Clock::now(), frame.arrived);
  }
  ASSERT_TRUE(first.has_value());
}

TEST(LiveVideo, AStreamThatEndsIsFoundAgain) {
  const NumberedClip clip(12, "-c:v mpeg2video", "clip.ts");
  const TcpSource source(ReadFileBytes(clip.path()));
  LiveVideoOptions options;
  options.retry_s = 0.01;
  LiveVideo live(source.url(), options);
  LiveImage frame;
  double last = -1;
  int frames = 0, losses = 0;
  for (bool lost = false; losses < 3;) {
    const Event event = live.Read(&frame);
    ASSERT_NE(event, Event::kEnd);
    if (event == Event::kLost) {
      EXPECT_THAT(live.message(), testing::StartsWith(source.url() + ": "));
      losses += lost ? 0 : 1;
    } else {
      EXPECT_GT(frame.seconds, last);
      EXPECT_EQ(frame.image.width, 96);
      last = frame.seconds;
      ++frames;
    }
    lost = event == Event::kLost;
  }
  EXPECT_GE(frames + live.late(), 3 * 10);
}

TEST(LiveVideo, AStreamThatIsSilentIsLostAfterTheTimeout) {
  int port = 0;
  const int silent = ListenAtLoopback(&port);
  LiveVideoOptions options;
  options.timeout_s = 0.05;
  const std::string url = "tcp://user:secret@127.0.0.1:" + std::to_string(port);
  EXPECT_THAT([&] { LiveVideo(url, options); },
              testing::ThrowsMessage<std::runtime_error>(testing::AllOf(
                  testing::StartsWith("tcp://user:***@127.0.0.1:"), testing::HasSubstr("not a stream"))));
  close(silent);
}

TEST(LiveVideo, StopsFromAnotherThread) {
  const NumberedClip clip(12, "-c:v mpeg4", "clip.mp4");
  LiveVideoOptions options;
  options.pace = 1e-6;  // the second frame is hours away
  LiveVideo live(clip.path(), options);
  LiveImage frame;
  ASSERT_EQ(live.Read(&frame), Event::kFrame);
  std::thread stopper([&] { live.Stop(); });
  EXPECT_EQ(live.Read(&frame), Event::kEnd);
  stopper.join();
}

TEST(LiveVideo, ReadsADeviceWhereLibavdeviceIs) {
  void* library = dlopen("libavdevice.so.59", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) GTEST_SKIP() << "no libavdevice here";
  LiveVideoOptions options;
  options.device = "no such kind";
  EXPECT_THAT([&] { LiveVideo("/dev/video0", options); },
              testing::ThrowsMessage<std::runtime_error>(
                  testing::HasSubstr("/dev/video0: this ffmpeg reads no cameras of the kind no such kind")));
  options.device = "v4l2";
  EXPECT_THAT([&] { LiveVideo("/dev/video-none", options); },
              testing::ThrowsMessage<std::runtime_error>(
                  testing::HasSubstr("/dev/video-none: not a camera that can be read (No such file or directory)")));
}

TEST(LiveVideo, RefusesWhatItCannotRead) {
  EXPECT_THAT([] { LiveVideo("no-such-file.mp4", {}); },
              testing::ThrowsMessage<std::runtime_error>(testing::StartsWith("no-such-file.mp4: ")));
  // Only network protocols: an address must not read a file of this machine.
  const NumberedClip clip(3, "-c:v mpeg4", "clip.mp4");
  LiveVideo(clip.path(), {});
  for (const std::string scheme : {"file://", "concat://", "subfile://", "async:file://"}) {
    EXPECT_THAT(
        [&] { LiveVideo(scheme + clip.path(), {}); },
        testing::ThrowsMessage<std::runtime_error>(testing::StartsWith(scheme + clip.path() + ": not a stream")));
  }
  LiveVideoOptions options;
  options.pace = -1;
  EXPECT_THROW(LiveVideo("clip.mp4", options), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::live_video_test
