// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/video_packets.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavdevice/version_major.h>
#include <libavformat/avformat.h>
}

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "data_tools/video/image_header.h"
#include "data_tools/video/libav_handles.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

void RequireFile(const std::string& path) {
  std::error_code error;
  if (!fs::exists(path, error)) throw std::runtime_error(path + ": no such video or folder of images");
  if (!fs::is_regular_file(path, error)) throw std::runtime_error(path + ": neither a regular file nor a folder");
  if (fs::file_size(path, error) == 0) throw std::runtime_error(path + ": the file is empty, expected a video");
}

/// MP4 files keep their index in one place, which recorders write last.
bool BeginsAsMp4(const std::string& path) {
  char start[8] = {};
  std::ifstream(path, std::ios::binary).read(start, sizeof start);
  return std::string_view(start + 4, 4) == "ftyp";
}

LibavPtr<AVFormatContext> Open(const std::string& path) {
  AVDictionary* options = nullptr;
  av_dict_set(&options, "protocol_whitelist", "file", 0);  // a playlist must not reach for the network
  AVFormatContext* context = nullptr;
  // An absolute path: ffmpeg would take "name:rest" for a protocol.
  const int result = avformat_open_input(&context, fs::absolute(path).c_str(), nullptr, &options);
  av_dict_free(&options);
  if (result >= 0) return LibavPtr<AVFormatContext>(context);
  throw std::runtime_error(path + (BeginsAsMp4(path)
                                       ? ": an MP4 file without a readable index, which recorders write "
                                         "last: it is cut off or damaged, expected a whole video"
                                       : ": not a video that ffmpeg can read (" + LibavReason(result) + ")"));
}

/// "rtsp://user:***@host/…" of "rtsp://user:secret@host/…".
std::string WithoutPassword(const std::string& address) {
  const size_t scheme = address.find("://");
  if (scheme == std::string::npos) return address;
  const size_t begin = scheme + 3, at = address.substr(0, address.find('/', begin)).rfind('@');
  const size_t colon = address.find(':', begin);
  if (at == std::string::npos || colon == std::string::npos || colon > at) return address;
  return address.substr(0, colon + 1) + "***" + address.substr(at);
}

/// The camera's kind of input. libavdevice is loaded when a camera is opened: it brings some sixty libraries, which
/// would slow the start of every program that reads a video.
const AVInputFormat* DeviceFormat(const std::string& device, const std::string& path) {
  const std::string file = "libavdevice.so." + std::to_string(LIBAVDEVICE_VERSION_MAJOR);
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    throw std::runtime_error(path + ": a camera needs " + file + " (Debian: libavdevice" +
                             std::to_string(LIBAVDEVICE_VERSION_MAJOR) + "), which is not installed");
  }
  const auto register_all = reinterpret_cast<void (*)()>(dlsym(library, "avdevice_register_all"));
  if (register_all == nullptr) throw std::runtime_error(path + ": " + file + " is not ffmpeg's");
  register_all();  // the library stays loaded, as ffmpeg now points into it
  const AVInputFormat* format = av_find_input_format(device.c_str());
  if (format == nullptr) throw std::runtime_error(path + ": this ffmpeg reads no cameras of the kind " + device);
  return format;
}

LibavPtr<AVFormatContext> OpenLive(const std::string& address, const std::string& path, const LiveInput& input,
                                   const std::function<bool()>* stop) {
  AVFormatContext* context = avformat_alloc_context();
  if (context == nullptr) throw std::bad_alloc();
  context->interrupt_callback.opaque = const_cast<std::function<bool()>*>(stop);  // only called
  context->interrupt_callback.callback = [](void* opaque) {
    const auto& poll = *static_cast<const std::function<bool()>*>(opaque);
    return poll && poll() ? 1 : 0;
  };
  context->max_analyze_duration = AV_TIME_BASE;
  AVDictionary* options = nullptr;
  const AVInputFormat* format = nullptr;
  if (input.device.empty()) {
    avformat_network_init();
    av_dict_set(&options, "protocol_whitelist", "rtsp,rtp,srtp,rtmp,rtmps,udp,tcp,tls,http,https,httpproxy,srt,crypto",
                0);
    av_dict_set(&options, "rtsp_flags", "prefer_tcp", 0);
  } else {
    try {
      format = DeviceFormat(input.device, path);
    } catch (...) {
      avformat_free_context(context);
      throw;
    }
    const std::string size = std::to_string(input.width) + "x" + std::to_string(input.height);
    if (input.width > 0 && input.height > 0) av_dict_set(&options, "video_size", size.c_str(), 0);
    if (input.fps > 0) av_dict_set(&options, "framerate", std::to_string(input.fps).c_str(), 0);
  }
  const int result = avformat_open_input(&context, address.c_str(), format, &options);  // frees the context on failure
  av_dict_free(&options);
  if (result >= 0) return LibavPtr<AVFormatContext>(context);
  throw std::runtime_error(
      path + (input.device.empty() ? ": not a stream that can be read (" : ": not a camera that can be read (") +
      LibavReason(result) + ")");
}

void RequireModestSize(const AVStream& stream, const std::string& path) {
  const int64_t width = stream.codecpar->width, height = stream.codecpar->height;
  if (stream.codecpar->codec_type != AVMEDIA_TYPE_VIDEO || width * height <= kMaxImagePixels) return;
  throw std::runtime_error(Concatenate(path, ": a video of ", width, "x", height, " pixels, expected at most ",
                                       kMaxImagePixels, "; scale it down"));
}

/// Determines properties missing in the container by decoding some frames.
void Probe(AVFormatContext* context) {
  std::vector<AVDictionary*> options(context->nb_streams, nullptr);
  for (AVDictionary*& one : options) av_dict_set_int(&one, "max_pixels", kMaxImagePixels, 0);
  // Its result is ignored: missing properties are determined below, or by the decoder.
  avformat_find_stream_info(context, options.empty() ? nullptr : options.data());
  for (AVDictionary*& one : options) av_dict_free(&one);
}

bool IsTextArt(AVCodecID codec) {
  return codec == AV_CODEC_ID_ANSI || codec == AV_CODEC_ID_BINTEXT || codec == AV_CODEC_ID_XBIN ||
         codec == AV_CODEC_ID_IDF;
}

AVStream* ImageStream(AVFormatContext* context, const std::string& path) {
  const int index = av_find_best_stream(context, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  AVStream* stream = index < 0 ? nullptr : context->streams[index];
  if (stream != nullptr && (stream->disposition & AV_DISPOSITION_ATTACHED_PIC) == 0) {
    if (IsTextArt(stream->codecpar->codec_id)) throw std::runtime_error(path + ": a text, expected a video");
    return stream;
  }
  const bool has_sound = av_find_best_stream(context, AVMEDIA_TYPE_AUDIO, -1, -1, nullptr, 0) >= 0;
  throw std::runtime_error(path + (has_sound ? ": sound without a video stream, expected a video"
                                             : ": holds no video stream, expected a video"));
}

bool IsMov(const AVFormatContext& context) { return std::string_view(context.iformat->name).starts_with("mov"); }

}  // namespace

VideoPackets::VideoPackets(const std::string& address, const LiveInput& input)
    : path_(WithoutPassword(address)), stop_(std::make_unique<const std::function<bool()>>(input.stop)) {
  QuietCodecs();
  context_ = OpenLive(address, path_, input, stop_.get());
  FindStream();
}

void VideoPackets::FindStream() {
  for (unsigned i = 0; i < context_->nb_streams; ++i) RequireModestSize(*context_->streams[i], path_);
  Probe(context_.get());
  stream_ = ImageStream(context_.get(), path_);
  RequireModestSize(*stream_, path_);
}

VideoPackets::VideoPackets(const std::string& path) : path_(path) {
  RequireFile(path);
  QuietCodecs();
  context_ = Open(path);
  FindStream();
  promised_ = stream_->nb_frames;
  if (promised_ > 0 && IsMov(*context_)) {
    // The index states which samples the edit list hides.
    exact_promise_ = true;
    promised_ = 0;
    for (int i = 0; i < avformat_index_get_entries_count(stream_); ++i) {
      promised_ += (avformat_index_get_entry(stream_, i)->flags & AVINDEX_DISCARD_FRAME) == 0;
    }
  }
  // Matroska states the duration of its longest stream, but no number of frames.
  const bool has_length = context_->duration > 0 && context_->duration_estimation_method == AVFMT_DURATION_FROM_STREAM;
  if (promised_ <= 0 && has_length && !IsMov(*context_)) {
    promised_s_ = static_cast<double>(context_->duration) / AV_TIME_BASE;
  }
  for (unsigned i = 0; i < context_->nb_streams && promised_s_ == 0; ++i) {
    if (context_->streams[i] != stream_) context_->streams[i]->discard = AVDISCARD_ALL;
  }
}

bool VideoPackets::Next(AVPacket* packet) {
  constexpr int kPatience = 1000;
  for (int again = 0; again < kPatience;) {
    av_packet_unref(packet);
    const int result = av_read_frame(context_.get(), packet);
    if (result == AVERROR(EAGAIN)) {
      ++again;
      continue;
    }
    if (result < 0) {
      if (result != AVERROR_EOF) failure_ = LibavReason(result);
      return false;
    }
    NoteEnd(*packet);
    if (packet->stream_index != stream_->index) continue;
    if ((packet->flags & AV_PKT_FLAG_CORRUPT) != 0 && context_->pb != nullptr && avio_feof(context_->pb) != 0) {
      ends_within_a_packet_ = true;
      continue;
    }
    delivered_ += (packet->flags & AV_PKT_FLAG_DISCARD) == 0;
    if (packet->size > 0) return true;  // AVI marks a repeated frame by an empty packet; to a decoder it is the end
  }
  return false;
}

void VideoPackets::NoteEnd(const AVPacket& packet) {
  if (promised_s_ == 0 || packet.pts == AV_NOPTS_VALUE) return;
  const double end = static_cast<double>(packet.pts) + static_cast<double>(packet.duration);
  end_s_ = std::max(end_s_, end * av_q2d(context_->streams[packet.stream_index]->time_base));
}

const AVStream& VideoPackets::stream() const { return *stream_; }

double VideoPackets::PixelAspect(const AVFrame& first) const {
  constexpr double kMaxRatio = 5, kRounding = 0.005;
  const AVRational ratio =
      av_guess_sample_aspect_ratio(context_.get(), stream_, const_cast<AVFrame*>(&first));  // only read
  if (ratio.num <= 0 || ratio.den <= 0) return 1;
  const double aspect = av_q2d(ratio);
  return aspect > kMaxRatio || aspect < 1 / kMaxRatio || std::abs(aspect - 1) <= kRounding ? 1 : aspect;
}

double VideoPackets::focal_35mm_mm() const {
  constexpr const char* kKey = "com.apple.quicktime.camera.focal_length.35mm_equivalent";
  for (const AVDictionary* notes : {stream_->metadata, context_->metadata}) {
    const AVDictionaryEntry* entry = av_dict_get(notes, kKey, nullptr, 0);
    if (entry == nullptr) continue;
    const double value = std::strtod(entry->value, nullptr);
    if (value > 0 && std::isfinite(value)) return value;  // cameras without the value write -1 and the like
  }
  return 0;
}

double VideoPackets::fps() const {
  const auto rate = [](AVRational value) {
    const double fps = value.den > 0 ? av_q2d(value) : 0;
    return fps > 0 && fps < 10000 ? fps : 0;
  };
  const double nominal = rate(stream_->r_frame_rate), mean = rate(stream_->avg_frame_rate);
  if (nominal == 0 || mean == 0) return std::max(nominal, mean);
  // The last frame's duration is arbitrary, which changes the total by up to about a frame.
  const double frames_off = std::abs(nominal / mean - 1) * std::max<double>(static_cast<double>(promised_), 100);
  return frames_off < 1.5 ? nominal : mean;
}

int VideoPackets::num_frames() const { return promised_ > 0 && promised_ < 100'000'000 ? int(promised_) : 0; }

std::string VideoPackets::CutOff() const {
  if (!failure_.empty()) return failure_;
  if (ends_within_a_packet_) return "it ends within a frame";
  // Frame counts of other containers may be off by a few frames, but not by a tenth of the video.
  const int64_t tolerance = exact_promise_ ? 0 : std::max<int64_t>(2, num_frames() / 10);
  constexpr double kToleranceSeconds = 0.25;
  if (end_s_ + kToleranceSeconds < promised_s_) return Concatenate("it promises ", promised_s_, " s");
  if (delivered_ + tolerance < num_frames()) return Concatenate("its index promises ", num_frames(), " frames");
  return "";
}

}  // namespace bodyloom
