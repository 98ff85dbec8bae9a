// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/video_reader.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "data_tools/video/frame_decoder.h"
#include "data_tools/video/frame_image.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/image_header.h"
#include "data_tools/video/video_packets.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

/// Returns true if each packet of the stream is a displayed frame; false for fields, and for VP8, which has hidden
/// frames.
bool HasAFrameAPacket(const AVCodecParameters& codec) {
  const bool progressive = codec.field_order == AV_FIELD_UNKNOWN || codec.field_order == AV_FIELD_PROGRESSIVE;
  return progressive && codec.codec_id != AV_CODEC_ID_VP8;
}

/// The timestamps of the frames in presentation order; nullopt if the packets do not determine them.
std::optional<std::vector<int64_t>> PacketTimestamps(VideoPackets* packets) {
  if (!HasAFrameAPacket(*packets->stream().codecpar)) return std::nullopt;
  const LibavPtr<AVPacket> packet = NewLibavPacket();
  std::vector<int64_t> shown;
  int64_t last_decoded = AV_NOPTS_VALUE, first_shown = AV_NOPTS_VALUE;
  while (packets->Next(packet.get())) {
    if (packet->pts == AV_NOPTS_VALUE || packet->dts == AV_NOPTS_VALUE) return std::nullopt;
    if (last_decoded != AV_NOPTS_VALUE && packet->dts <= last_decoded) return std::nullopt;
    if (last_decoded == AV_NOPTS_VALUE) {
      if ((packet->flags & AV_PKT_FLAG_KEY) == 0) return std::nullopt;
      first_shown = packet->pts;
    }
    last_decoded = packet->dts;
    // Shown before the first key frame: it refers to missing frames.
    if (packet->pts < first_shown) return std::nullopt;
    if ((packet->flags & AV_PKT_FLAG_DISCARD) == 0) shown.push_back(packet->pts);
  }
  std::sort(shown.begin(), shown.end());
  if (shown.empty() || std::adjacent_find(shown.begin(), shown.end()) != shown.end()) return std::nullopt;
  return shown;
}

}  // namespace

class VideoReader::Source {
 public:
  virtual ~Source() = default;
  virtual bool Read(Image* frame) = 0;
  virtual int Skip(int count) = 0;
  virtual int SkipTo(double seconds) = 0;
  [[nodiscard]] virtual double frame_time() const = 0;
  [[nodiscard]] virtual std::string warning() const = 0;
  [[nodiscard]] virtual std::string note() const = 0;
  [[nodiscard]] const VideoInfo& info() const { return info_; }
  [[nodiscard]] int next_frame() const { return next_; }

 protected:
  void RequireSize(const std::string& where, int width, int height) const {
    if (width == info_.width && height == info_.height) return;
    throw std::runtime_error(Concatenate(where, ": image of ", width, "x", height, " pixels, expected ", info_.width,
                                         "x", info_.height, " as the first frame"));
  }

  VideoInfo info_;
  int next_ = 0;
};

class VideoReader::ImagesSource : public Source {
 public:
  ImagesSource(const std::string& path, std::vector<std::string> files, int turn_deg)
      : path_(path), files_(std::move(files)), turn_(ClockwiseTurn(turn_deg)) {
    const std::string bytes = ReadImageBytes(files_[0]);
    first_ = Oriented(DecodeImage(bytes, files_[0]), turn_);
    if (const std::optional<JpegHeader> jpeg = ReadJpegHeader(bytes)) info_.focal_35mm_mm = jpeg->focal_35mm_mm;
    info_.width = info_.stored_width = first_.width;
    info_.height = info_.stored_height = first_.height;
    info_.num_frames = static_cast<int>(files_.size());
  }

  bool Read(Image* frame) override {
    if (next_ >= info_.num_frames) return false;
    if (next_ == 0 && !first_.empty()) {
      *frame = std::move(first_);
      first_ = Image();
    } else {
      *frame = Oriented(ReadImage(files_[next_]), turn_);
      RequireSize(files_[next_], frame->width, frame->height);
    }
    ++next_;
    return true;
  }

  int Skip(int count) override {
    const int skipped = std::clamp(count, 0, info_.num_frames - next_);
    next_ += skipped;
    return skipped;
  }

  int SkipTo(double seconds) override {
    throw std::runtime_error(
        Concatenate(path_, ": images have no clock to find ", seconds, " s on, expected the number of a frame"));
  }

  [[nodiscard]] double frame_time() const override { return std::numeric_limits<double>::quiet_NaN(); }
  [[nodiscard]] std::string warning() const override { return ""; }
  [[nodiscard]] std::string note() const override { return ""; }

 private:
  std::string path_;
  std::vector<std::string> files_;
  DisplayOrientation turn_;
  Image first_;  ///< read on opening to learn the size
};

class VideoReader::FileSource : public Source {
 public:
  FileSource(const std::string& path, int turn_deg) : path_(path), decoder_(path) {
    if (!Peek()) throw std::runtime_error(path + ": the video holds no frame that can be decoded");
    const VideoPackets& packets = decoder_.packets();
    converter_ = std::make_unique<FrameImage>(path, packets.stream(), packets.PixelAspect(decoder_.frame()), turn_deg);
    const FrameSize square = converter_->SizeOf(decoder_.frame()), stored = converter_->StoredSizeOf(decoder_.frame());
    if (int64_t{square.width} * square.height > kMaxImagePixels) {
      throw std::runtime_error(Concatenate(path, ": a video of ", square.width, "x", square.height,
                                           " square pixels, expected at most ", kMaxImagePixels, "; scale it down"));
    }
    converter_->Convert(decoder_.frame(), &first_);
    info_.width = square.width;
    info_.height = square.height;
    info_.stored_width = stored.width;
    info_.stored_height = stored.height;
    info_.fps = decoder_.packets().fps();
    info_.focal_35mm_mm = decoder_.packets().focal_35mm_mm();
    info_.num_frames = decoder_.packets().num_frames();
  }

  bool Read(Image* frame) override {
    if (!Peek()) return false;
    const AVFrame& decoded = decoder_.frame();
    const FrameSize size = converter_->SizeOf(decoded);
    RequireSize(Concatenate(path_, ": frame ", next_), size.width, size.height);
    if (!first_.empty()) {
      *frame = std::move(first_);
    } else {
      converter_->Convert(decoded, frame);
    }
    Pass();
    return true;
  }

  int Skip(int count) override {
    int skipped = 0;
    for (; skipped < count && Peek(); ++skipped) Pass();
    return skipped;
  }

  int SkipTo(double seconds) override {
    constexpr double kMicrosecond = 1e-6;
    int skipped = 0;
    for (; Peek() && decoder_.time() < seconds - kMicrosecond; ++skipped) Pass();
    return skipped;
  }

  [[nodiscard]] double frame_time() const override { return time_s_; }

  [[nodiscard]] std::string warning() const override {
    std::string what;
    const auto add = [&what](const std::string& part) { what += (what.empty() ? "" : "; ") + part; };
    if (decoder_.num_lost() > 0) add(Concatenate(decoder_.num_lost(), " frames cannot be decoded and are left out"));
    if (decoder_.num_damaged() > 0) add(Concatenate(decoder_.num_damaged(), " frames are damaged"));
    const std::string cut_off = ended_ ? decoder_.packets().CutOff() : "";
    if (!cut_off.empty()) add(Concatenate("cut off or damaged after ", next_, " frames (", cut_off, ")"));
    return what.empty() ? "" : path_ + ": " + what;
  }

  [[nodiscard]] std::string note() const override {
    std::string what;
    if (decoder_.is_interlaced()) what = "interlaced, each frame is made of its first field";
    if (info_.IsAnamorphic()) {
      what += Concatenate(what.empty() ? "" : "; ", "its pixels are not square: frames of ", info_.stored_width, "x",
                          info_.stored_height, " are shown as ", info_.width, "x", info_.height);
    }
    return what.empty() ? "" : path_ + ": " + what;
  }

 private:
  /// Decodes the next frame; returns false if there is none.
  bool Peek() {
    if (!has_frame_ && !ended_) {
      has_frame_ = decoder_.Next();
      ended_ = !has_frame_;
    }
    return has_frame_;
  }

  void Pass() {
    first_ = Image();
    has_frame_ = false;
    time_s_ = decoder_.time();
    ++next_;
  }

  std::string path_;
  FrameDecoder decoder_;
  std::unique_ptr<FrameImage> converter_;
  Image first_;  ///< converted on opening, so that unsupported formats are refused there
  bool has_frame_ = false, ended_ = false;
  double time_s_ = 0;
};

VideoReader::VideoReader(const std::string& path, int turn_deg) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    source_ = std::make_unique<ImagesSource>(path, ImageFilesOf(path), turn_deg);
  } else if (IsImageName(path) && std::filesystem::is_regular_file(path, error)) {
    // ReadImage orients photos by their EXIF.
    source_ = std::make_unique<ImagesSource>(path, std::vector<std::string>{path}, turn_deg);
  } else {
    source_ = std::make_unique<FileSource>(path, turn_deg);
  }
}
VideoReader::~VideoReader() = default;
const VideoInfo& VideoReader::info() const { return source_->info(); }
bool VideoReader::Read(Image* frame) { return source_->Read(frame); }
int VideoReader::Skip(int count) { return source_->Skip(count); }
int VideoReader::SkipTo(double seconds) { return source_->SkipTo(seconds); }
int VideoReader::next_frame() const { return source_->next_frame(); }
double VideoReader::frame_time() const { return source_->frame_time(); }
std::string VideoReader::warning() const { return source_->warning(); }
std::string VideoReader::note() const { return source_->note(); }

std::vector<double> VideoFrameTimes(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error) || IsImageName(path)) return {};
  std::vector<double> times;
  VideoPackets packets(path);
  if (const auto timestamps = PacketTimestamps(&packets)) {
    FrameClock clock = ClockOf(packets);
    for (const int64_t timestamp : *timestamps) times.push_back(clock.Next(timestamp));
    return times;
  }
  FrameDecoder decoder(path);
  while (decoder.Next()) times.push_back(decoder.time());
  if (times.empty()) throw std::runtime_error(path + ": the video holds no frame that can be decoded");
  return times;
}

}  // namespace bodyloom
