// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/live_video.h"

#include <arpa/inet.h>
#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <thread>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/video_reader.h"
#include "tests/data_tools/video/clip_maker.h"

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

/// Serves bytes to each client in turn at a free port of 127.0.0.1, and hangs up.
class TcpSource {
 public:
  explicit TcpSource(std::string bytes) : bytes_(std::move(bytes)), socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(listen(socket_, 4), 0);
    EXPECT_EQ(getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    url_ = "tcp://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    thread_ = std::thread([this] {
      for (;;) {
        const int client = accept(socket_, nullptr, nullptr);
        if (client < 0) return;
        for (size_t at = 0; at < bytes_.size();) {
          const ssize_t sent = send(client, bytes_.data() + at, bytes_.size() - at, MSG_NOSIGNAL);
          if (sent <= 0) break;
          at += size_t(sent);
        }
        close(client);
      }
    });
  }
  ~TcpSource() {
    shutdown(socket_, SHUT_RDWR);
    thread_.join();
    close(socket_);
  }
  TcpSource(const TcpSource&) = delete;
  TcpSource& operator=(const TcpSource&) = delete;
  [[nodiscard]] const std::string& url() const { return url_; }

 private:
  std::string bytes_, url_;
  int socket_;
  std::thread thread_;
};

TEST(LiveVideo, TellsSourcesByTheirNames) {
  EXPECT_EQ(LiveSourceKindOf("/dev/video0"), LiveSourceKind::kCamera);
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
  const int silent = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(silent, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(listen(silent, 4), 0);
  ASSERT_EQ(getsockname(silent, reinterpret_cast<sockaddr*>(&address), &size), 0);
  LiveVideoOptions options;
  options.timeout_s = 0.05;
  const std::string url = "tcp://user:secret@127.0.0.1:" + std::to_string(ntohs(address.sin_port));
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
  EXPECT_THAT([&] { LiveVideo("/dev/no-such-camera", options); },
              testing::ThrowsMessage<std::runtime_error>(testing::HasSubstr(
                  "/dev/no-such-camera: not a camera that can be read (No such file or directory)")));
}

TEST(LiveVideo, RefusesWhatItCannotRead) {
  EXPECT_THAT([] { LiveVideo("no-such-file.mp4", {}); },
              testing::ThrowsMessage<std::runtime_error>(testing::StartsWith("no-such-file.mp4: ")));
  // Only network protocols: an address must not read a file of this machine.
  EXPECT_THAT([] { LiveVideo("file:///etc/hostname", {}); },
              testing::ThrowsMessage<std::runtime_error>(testing::StartsWith("file:///etc/hostname: not a stream")));
  EXPECT_THAT([] { LiveVideo("concat://etc/hostname", {}); }, testing::Throws<std::runtime_error>());
  LiveVideoOptions options;
  options.pace = -1;
  EXPECT_THROW(LiveVideo("clip.mp4", options), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::live_video_test
