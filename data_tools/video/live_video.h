// SPDX-License-Identifier: Apache-2.0
/// Reads the frames of a camera, of a network stream or of a file at its own pace, each when it is due.
///
///   source             kind
///   /dev/video0        camera (Video4Linux), as is any other character device
///   rtsp://host/name   stream: rtsp, http, https, udp, rtp, rtmp, srt
///   clip.mp4           file
/// A frame's arrival is the moment at which its packet was there, before it was decoded; for a file the moment at which
/// it is due, as if a camera had filmed it then. Frames that come too late are passed over (FramePace) and counted. A
/// camera or stream that ends, fails or is silent for longer than the timeout is lost, and opened again until it is
/// found.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "render/image/image.h"

namespace bodyloom {

enum class LiveSourceKind { kCamera, kStream, kFile };
LiveSourceKind LiveSourceKindOf(const std::string& source);

struct LiveVideoOptions {
  /// Of a file: how many times as fast as it is played. 0: without waiting, and no frame is passed over.
  double pace = 1;
  int turn_deg = 0;             ///< frames are turned clockwise by 0, 90, 180 or 270 degrees
  int width = 0, height = 0;    ///< asked of a camera; 0: its own choice
  double fps = 0;               ///< likewise
  double timeout_s = 5;         ///< a camera or stream without a packet for longer is lost
  double retry_s = 1;           ///< between two tries to find it again
  std::string device = "v4l2";  ///< libavdevice's name of the kind of camera
};

struct LiveImage {
  using Clock = std::chrono::steady_clock;
  Image image;
  /// Since the first frame, strictly increasing: by the frames' timestamps, and over a loss by the clock.
  double seconds = 0;
  Clock::time_point arrived;
};

/// Tells frames that come too late to be of use: a fifth of a second after they are due. A file's frames are due by its
/// first one's time. Those of a sender, which has a clock of its own, are due with the least delay seen; that is
/// forgotten by a thousandth of the time passed, as clocks differ by less. When no frame has been in time for two
/// seconds, it is the source that stood still, and frames are due by the newest one from then on. Times are seconds.
class FramePace {
 public:
  explicit FramePace(bool is_file) : is_file_(is_file) {}

  /// A frame of the source's time `source_s` that is in time at `now_s`; those that follow are due by it.
  void Restart(double source_s, double now_s) {
    zero_s_ = now_s - source_s;
    last_s_ = in_time_s_ = now_s;
  }
  /// Returns true if the frame is to be passed over. Neither time decreases from call to call.
  bool IsLate(double source_s, double now_s);
  /// The moment at which a frame is due.
  [[nodiscard]] double Due(double source_s) const { return zero_s_ + source_s; }

 private:
  bool is_file_;
  double zero_s_ = 0, last_s_ = 0, in_time_s_ = 0;
};

class LiveVideo {
 public:
  enum class Event {
    kFrame,
    kLost,  ///< the source: message() says why; the next Read() waits a moment and looks for it
    kEnd    ///< of a file, or Stop()
  };

  /// Opens the source. Throws std::runtime_error naming it when that fails, and std::invalid_argument for options out
  /// of range.
  LiveVideo(const std::string& source, const LiveVideoOptions& options);
  ~LiveVideo();
  LiveVideo(const LiveVideo&) = delete;
  LiveVideo& operator=(const LiveVideo&) = delete;

  /// Waits for the next frame. Frames have one size until the source is lost.
  Event Read(LiveImage* frame);
  /// Makes Read() return kEnd soon. May be called from any thread.
  void Stop();

  [[nodiscard]] LiveSourceKind kind() const { return kind_; }
  [[nodiscard]] double fps() const;  ///< of the source; 0: unknown
  /// Reason of the last loss, a line that names the source.
  [[nodiscard]] const std::string& message() const { return message_; }
  /// Number of frames that were passed over because they came too late. May be called from any thread.
  [[nodiscard]] int64_t late() const { return late_; }

 private:
  class Decoder;
  void Open();
  /// Waits until `time`, or Stop().
  void WaitUntil(LiveImage::Clock::time_point time);
  /// Seconds of LiveImage of a frame at this time of the decoder's, which is due at `due_s`.
  double SecondsOf(double decoder_s, double due_s);

  const std::string source_;
  const LiveVideoOptions options_;
  const LiveSourceKind kind_;
  std::unique_ptr<Decoder> decoder_;
  std::string message_;
  std::atomic<bool> stop_ = false;
  std::atomic<int64_t> late_ = 0;
  std::mutex mutex_;
  std::condition_variable stopped_;
  FramePace pace_;
  double start_s_ = 0;  ///< the first frame's arrival, on LiveImage::Clock
  bool started_ = false, opened_anew_ = true;
  double shift_s_ = 0, seconds_ = 0;
};

}  // namespace bodyloom
