// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/frame_decoder.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavfilter/avfilter.h>
#include <libavfilter/buffersink.h>
#include <libavfilter/buffersrc.h>
#include <libavformat/avformat.h>
#include <libavutil/frame.h>
}

#include <stdexcept>
#include <utility>

#include "data_tools/video/image_header.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

LibavPtr<AVCodecContext> OpenDecoder(const VideoPackets& packets, bool low_delay) {
  const AVStream& stream = packets.stream();
  const AVCodec* decoder = avcodec_find_decoder(stream.codecpar->codec_id);
  if (decoder == nullptr) {
    throw std::runtime_error(packets.path() + ": a video coded as " + avcodec_get_name(stream.codecpar->codec_id) +
                             ", for which this ffmpeg has no decoder");
  }
  LibavPtr<AVCodecContext> codec(avcodec_alloc_context3(decoder));
  if (!codec) throw std::bad_alloc();
  int result = avcodec_parameters_to_context(codec.get(), stream.codecpar);
  codec->pkt_timebase = stream.time_base;
  codec->max_pixels = kMaxImagePixels;
  codec->thread_count = low_delay ? 1 : 0;
  codec->thread_type = FF_THREAD_FRAME | FF_THREAD_SLICE;
  if (result >= 0) result = avcodec_open2(codec.get(), decoder, nullptr);
  if (result < 0) {
    throw std::runtime_error(packets.path() + ": a video coded as " + decoder->name + " that cannot be decoded (" +
                             LibavReason(result) + ")");
  }
  return codec;
}

}  // namespace

Deinterlacer::Deinterlacer(const std::string& path, const AVFrame& first)
    : path_(path), graph_(avfilter_graph_alloc()) {
  if (!graph_) throw std::bad_alloc();
  // The times of the pictures are kept by the caller, so frames are only numbered here.
  const std::string form =
      Concatenate("video_size=", first.width, "x", first.height, ":pix_fmt=", first.format, ":time_base=1/1");
  AVFilterContext* filter = nullptr;
  const auto add = [&](AVFilterContext** context, const char* name, const char* arguments) {
    return avfilter_graph_create_filter(context, avfilter_get_by_name(name), name, arguments, nullptr, graph_.get());
  };
  int result = add(&source_, "buffer", form.c_str());
  if (result >= 0) result = add(&filter, "bwdif", "mode=send_frame:parity=auto:deint=interlaced");
  if (result >= 0) result = add(&sink_, "buffersink", nullptr);
  if (result >= 0) result = avfilter_link(source_, 0, filter, 0);
  if (result >= 0) result = avfilter_link(filter, 0, sink_, 0);
  if (result >= 0) result = avfilter_graph_config(graph_.get(), nullptr);
  if (result < 0) {
    throw std::runtime_error(path + ": an interlaced video whose fields cannot be separated (" + LibavReason(result) +
                             "); convert it with ffmpeg -vf bwdif");
  }
}

void Deinterlacer::Push(AVFrame* frame) {
  if (frame != nullptr) frame->pts = num_frames_++;
  const int result = av_buffersrc_add_frame_flags(source_, frame, AV_BUFFERSRC_FLAG_KEEP_REF);
  if (result >= 0) return;
  throw std::runtime_error(Concatenate(path_, ": frame ", num_frames_ - 1,
                                       " of an interlaced video differs in size or pixel format from those before (",
                                       LibavReason(result), ")"));
}

bool Deinterlacer::Pull(AVFrame* picture) {
  av_frame_unref(picture);
  return av_buffersink_get_frame(sink_, picture) >= 0;
}

FrameClock ClockOf(const VideoPackets& packets) {
  const AVRational tick = packets.stream().time_base;
  return {tick.num, tick.den, 1 / (packets.fps() > 0 ? packets.fps() : 25)};
}

FrameDecoder::FrameDecoder(const std::string& path) : FrameDecoder(VideoPackets(path), false) {}

FrameDecoder::FrameDecoder(VideoPackets packets, bool low_delay)
    : packets_(std::move(packets)),
      codec_(OpenDecoder(packets_, low_delay)),
      frame_(NewLibavFrame()),
      packet_(NewLibavPacket()),
      clock_(ClockOf(packets_)) {}

bool FrameDecoder::Feed() {
  if (draining_) return false;
  draining_ = !packets_.Next(packet_.get());
  packet_arrived_ = std::chrono::steady_clock::now();
  // Without a packet it returns delayed frames. A result other than 0 is a frame that it could not decode.
  if (avcodec_send_packet(codec_.get(), draining_ ? nullptr : packet_.get()) < 0) ++lost_;
  return true;
}

bool FrameDecoder::Next() {
  for (;;) {
    if (deinterlacer_ && deinterlacer_->Pull(frame_.get())) {
      time_s_ = times_in_deinterlacer_.front();
      times_in_deinterlacer_.pop_front();
      return true;
    }
    if (Decode()) {
      if (!deinterlacer_ && !frame_->interlaced_frame) return true;
      if (!deinterlacer_) deinterlacer_.emplace(packets_.path(), *frame_);
      times_in_deinterlacer_.push_back(time_s_);
      deinterlacer_->Push(frame_.get());
    } else if (deinterlacer_ && !deinterlacer_draining_) {
      deinterlacer_draining_ = true;
      deinterlacer_->Push(nullptr);
    } else {
      return false;
    }
  }
}

bool FrameDecoder::Decode() {
  constexpr int kPatience = 10'000;  // bounds failures of a decoder that takes no packet
  for (int failures = 0; failures < kPatience;) {
    const int result = avcodec_receive_frame(codec_.get(), frame_.get());
    if (result == AVERROR_EOF) return false;
    if (result == AVERROR(EAGAIN)) {
      if (!Feed()) return false;
    } else if (result < 0) {
      ++lost_;
      ++failures;
    } else {
      damaged_ += frame_->decode_error_flags != 0;
      const int64_t timestamp = frame_->best_effort_timestamp;
      time_s_ = clock_.Next(timestamp == AV_NOPTS_VALUE ? std::nullopt : std::optional(timestamp));
      return true;
    }
  }
  return false;
}

FrameClock::FrameClock(int numerator, int denominator, double frame_s)
    : tick_numerator_(numerator), tick_denominator_(denominator), frame_s_(frame_s) {}

double FrameClock::Next(std::optional<int64_t> timestamp) {
  double seconds = last_s_ + (has_last_ ? frame_s_ : 0);
  int64_t ticks = 0;
  if (timestamp && !origin_) {
    origin_ = timestamp;
    shift_s_ = seconds;
  }
  if (timestamp && !__builtin_sub_overflow(*timestamp, *origin_, &ticks)) {
    const double shown = static_cast<double>(ticks) * tick_numerator_ / tick_denominator_ + shift_s_;
    if (!has_last_ || shown > last_s_) {
      seconds = shown;
    } else if (shown < last_s_ - 1) {
      shift_s_ += seconds - shown;
    } else {
      seconds = last_s_ + frame_s_ / 2;
    }
  }
  last_s_ = seconds;
  has_last_ = true;
  return seconds;
}

}  // namespace bodyloom
