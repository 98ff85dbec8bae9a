// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/live_video.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "data_tools/video/frame_decoder.h"
#include "data_tools/video/frame_image.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using LiveClock = LiveImage::Clock;

constexpr double kLateFrame_s = 0.2, kStoodStill_s = 2;
constexpr double kClockDrift = 1e-3;

LiveClock::duration ToDuration(double seconds) {
  return std::chrono::duration_cast<LiveClock::duration>(std::chrono::duration<double>(seconds));
}
double ToSeconds(LiveClock::time_point time) { return std::chrono::duration<double>(time.time_since_epoch()).count(); }

}  // namespace

LiveSourceKind LiveSourceKindOf(const std::string& source) {
  if (source.find("://") != std::string::npos) return LiveSourceKind::kStream;
  std::error_code error;
  const bool is_device = source.starts_with("/dev/video") || std::filesystem::is_character_file(source, error);
  return is_device ? LiveSourceKind::kCamera : LiveSourceKind::kFile;
}

bool FramePace::IsLate(double source_s, double now_s) {
  const double own_zero_s = now_s - source_s;
  if (!is_file_) zero_s_ = std::min(zero_s_ + kClockDrift * (now_s - last_s_), own_zero_s);
  last_s_ = now_s;
  const bool is_late = own_zero_s - zero_s_ > kLateFrame_s;
  if (is_late && now_s - in_time_s_ <= kStoodStill_s) return true;
  if (is_late) zero_s_ = own_zero_s;
  in_time_s_ = now_s;
  return false;
}

/// An open source.
class LiveVideo::Decoder {
 public:
  Decoder(const std::string& source, LiveSourceKind kind, const LiveVideoOptions& options,
          const std::atomic<bool>& stop)
      : decoder_(Packets(source, kind, options, stop), true), turn_deg_(options.turn_deg) {}

  bool Next() {
    deadline_ = LiveClock::now() + ToDuration(timeout_s_);
    return decoder_.Next();
  }
  [[nodiscard]] double time() const { return decoder_.time(); }
  [[nodiscard]] LiveClock::time_point packet_arrived() const { return decoder_.packet_arrived(); }
  [[nodiscard]] double fps() const { return decoder_.packets().fps(); }
  /// Of the packets' end.
  [[nodiscard]] std::string Reason() const {
    const std::string cut_off = decoder_.packets().CutOff();
    return decoder_.packets().path() + ": " + (cut_off.empty() ? "the source ended" : cut_off);
  }
  void Convert(Image* image) {
    const VideoPackets& packets = decoder_.packets();
    if (!converter_) {
      converter_.emplace(packets.path(), packets.stream(), packets.PixelAspect(decoder_.frame()), turn_deg_);
      size_ = converter_->SizeOf(decoder_.frame());
    }
    const FrameSize size = converter_->SizeOf(decoder_.frame());
    if (size != size_) {
      throw std::runtime_error(Concatenate(packets.path(), ": a frame of ", size.width, "x", size.height,
                                           " pixels, expected ", size_.width, "x", size_.height, " as before"));
    }
    converter_->Convert(decoder_.frame(), image);
  }

 private:
  VideoPackets Packets(const std::string& source, LiveSourceKind kind, const LiveVideoOptions& options,
                       const std::atomic<bool>& stop) {
    if (kind == LiveSourceKind::kFile) return VideoPackets(source);
    LiveInput input;
    if (kind == LiveSourceKind::kCamera) input.device = options.device;
    input.width = options.width;
    input.height = options.height;
    input.fps = options.fps;
    timeout_s_ = options.timeout_s;
    deadline_ = LiveClock::now() + ToDuration(timeout_s_);
    input.stop = [this, &stop] { return stop || LiveClock::now() > deadline_; };
    return VideoPackets(source, input);
  }

  // Before the decoder, whose packets set and read them.
  double timeout_s_ = 0;
  LiveClock::time_point deadline_;
  FrameDecoder decoder_;
  int turn_deg_;
  std::optional<FrameImage> converter_;
  FrameSize size_;
};

LiveVideo::LiveVideo(const std::string& source, const LiveVideoOptions& options)
    : source_(source), options_(options), kind_(LiveSourceKindOf(source)), pace_(kind_ == LiveSourceKind::kFile) {
  BODYLOOM_CHECK(options.pace >= 0 && std::isfinite(options.pace), "live video: a pace of ", options.pace,
                 ", expected 0 or more");
  BODYLOOM_CHECK(options.timeout_s > 0 && options.retry_s >= 0, "live video: lost after ", options.timeout_s,
                 " s, looked for every ", options.retry_s, " s, expected positive times");
  Open();
}
LiveVideo::~LiveVideo() = default;

void LiveVideo::Open() {
  decoder_.reset();  // a camera is opened once at a time
  decoder_ = std::make_unique<Decoder>(source_, kind_, options_, stop_);
  opened_anew_ = true;
}

double LiveVideo::fps() const { return decoder_ ? decoder_->fps() : 0; }

void LiveVideo::Stop() {
  const std::lock_guard lock(mutex_);
  stop_ = true;
  stopped_.notify_all();
}

void LiveVideo::WaitUntil(LiveClock::time_point time) {
  std::unique_lock lock(mutex_);
  stopped_.wait_until(lock, time, [this] { return stop_.load(); });
}

double LiveVideo::SecondsOf(double decoder_s, double due_s) {
  if (opened_anew_) {
    if (!started_) start_s_ = due_s;
    // A source found again continues by the clock, after the frames before.
    shift_s_ = started_ ? std::max(due_s - start_s_, seconds_ + 1e-3) - decoder_s : -decoder_s;
    started_ = true;
    opened_anew_ = false;
  }
  seconds_ = decoder_s + shift_s_;
  return seconds_;
}

LiveVideo::Event LiveVideo::Read(LiveImage* frame) {
  while (!stop_) {
    try {
      if (!decoder_) {
        WaitUntil(LiveClock::now() + ToDuration(options_.retry_s));
        if (stop_) break;
        Open();
      }
      if (!decoder_->Next()) {
        if (kind_ == LiveSourceKind::kFile || stop_) break;
        message_ = decoder_->Reason();
        decoder_.reset();
        return Event::kLost;
      }
      const bool is_file = kind_ == LiveSourceKind::kFile;
      const double at = decoder_->time(), source_s = is_file && options_.pace > 0 ? at / options_.pace : at;
      const LiveClock::time_point arrived = is_file ? LiveClock::now() : decoder_->packet_arrived();
      if (opened_anew_) pace_.Restart(source_s, ToSeconds(arrived));
      const double seconds = SecondsOf(at, ToSeconds(arrived));
      const bool has_pace = !is_file || options_.pace > 0;
      if (has_pace && pace_.IsLate(source_s, ToSeconds(arrived))) {
        ++late_;
        continue;
      }
      decoder_->Convert(&frame->image);
      frame->seconds = seconds;
      frame->arrived = arrived;
      if (is_file && has_pace) {
        frame->arrived = LiveClock::time_point(ToDuration(pace_.Due(source_s)));
        WaitUntil(frame->arrived);
        if (stop_) break;
      }
      return Event::kFrame;
    } catch (const std::runtime_error& error) {
      if (kind_ == LiveSourceKind::kFile) throw;
      decoder_.reset();
      if (stop_) break;
      message_ = error.what();
      return Event::kLost;
    }
  }
  return Event::kEnd;
}

}  // namespace bodyloom
