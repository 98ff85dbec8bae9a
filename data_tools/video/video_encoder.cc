// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/video_encoder.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <filesystem>
#include <new>
#include <opencv2/core.hpp>
#include <stdexcept>

#include "data_tools/video/libav_handles.h"
#include "render/image/image_mat.h"

namespace bodyloom {
namespace {

/// The colours are BT.601's, of limited range, and the file says so.
void DescribeImage(int width, int height, AVRational fps, AVCodecContext* codec) {
  codec->width = width;
  codec->height = height;
  codec->time_base = av_inv_q(fps);
  codec->framerate = fps;
  codec->pix_fmt = AV_PIX_FMT_YUV420P;
  codec->colorspace = AVCOL_SPC_SMPTE170M;
  codec->color_range = AVCOL_RANGE_MPEG;
  codec->chroma_sample_location = AVCHROMA_LOC_LEFT;
  // One thread: the bytes must not depend on the number of processors.
  codec->thread_count = 1;
  codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;  // required by .mp4
}

/// x264 (r3095) with AVX-512 sometimes gives different bytes for the same frames when its macroblock tree is on; with
/// the other instruction sets of these processors it does not (docs/lab/video.md). The list replaces x264's detection,
/// so it is only used if all of it is supported.
void UseRepeatableInstructions(AVCodecContext* codec) {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f")) {
    av_opt_set(codec->priv_data, "x264-params", "asm=MMX2,SSE2Fast,SSSE3,SSE4.2,AVX,FMA3,BMI2,AVX2", 0);
  }
#else
  static_cast<void>(codec);
#endif
}

LibavPtr<AVCodecContext> OpenEncoder(const AVCodec* encoder, int width, int height, AVRational fps) {
  if (encoder == nullptr) return nullptr;
  LibavPtr<AVCodecContext> codec(avcodec_alloc_context3(encoder));
  if (!codec) throw std::bad_alloc();
  DescribeImage(width, height, fps, codec.get());
  if (encoder->id == AV_CODEC_ID_H264) {
    // Fast, since overlays are transient: at equal PSNR "veryfast" takes 1.6 times as long for two thirds of the bytes
    // (docs/lab/run_speed.md).
    av_opt_set(codec->priv_data, "preset", "superfast", 0);
    av_opt_set(codec->priv_data, "crf", "22", 0);
    UseRepeatableInstructions(codec.get());
  } else {
    constexpr int kQuantiser = 3;
    codec->flags |= AV_CODEC_FLAG_QSCALE;
    codec->global_quality = kQuantiser * FF_QP2LAMBDA;
  }
  return avcodec_open2(codec.get(), encoder, nullptr) < 0 ? nullptr : std::move(codec);
}

/// To YCbCr, with chroma averaged around the position stated in the file.
LibavPtr<SwsContext> NewScaler(int width, int height) {
  LibavPtr<SwsContext> scaler(sws_alloc_context());
  if (!scaler) throw std::bad_alloc();
  for (const char* side : {"srcw", "dstw"}) av_opt_set_int(scaler.get(), side, width, 0);
  for (const char* side : {"srch", "dsth"}) av_opt_set_int(scaler.get(), side, height, 0);
  av_opt_set_int(scaler.get(), "src_format", AV_PIX_FMT_BGR24, 0);
  av_opt_set_int(scaler.get(), "dst_format", AV_PIX_FMT_YUV420P, 0);
  av_opt_set_int(scaler.get(), "sws_flags", SWS_BILINEAR | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP, 0);
  av_opt_set_int(scaler.get(), "dst_h_chr_pos", 0, 0);
  av_opt_set_int(scaler.get(), "dst_v_chr_pos", 128, 0);
  if (sws_init_context(scaler.get(), nullptr, nullptr) < 0) throw std::bad_alloc();
  return scaler;
}

}  // namespace

class VideoEncoder::Output {
 public:
  Output(const std::string& file, const std::string& path, int width, int height, double fps)
      : width_((width + 1) / 2 * 2), height_((height + 1) / 2 * 2), frame_(NewLibavFrame()), packet_(NewLibavPacket()) {
    QuietCodecs();
    constexpr int kMaxOfAFraction = 65535;  // MPEG-4's
    OpenCodec(path, av_d2q(fps, kMaxOfAFraction));
    OpenFile(file, path);
    frame_->width = width_;
    frame_->height = height_;
    frame_->format = AV_PIX_FMT_YUV420P;
    frame_->colorspace = codec_->colorspace;
    frame_->color_range = codec_->color_range;
    if (av_frame_get_buffer(frame_.get(), 0) < 0) throw std::bad_alloc();
    scaler_ = NewScaler(width_, height_);
  }

  void Write(const Image& image) {
    // swscale reads some bytes beyond the last pixel: allocates one more row.
    padded_.create(height_ + 1, width_, CV_8UC3);
    cv::Mat bgr = padded_.rowRange(0, height_);
    cv::copyMakeBorder(MatOf(image), bgr, 0, height_ - image.height, 0, width_ - image.width, cv::BORDER_REPLICATE);
    bgr.row(height_ - 1).copyTo(padded_.row(height_));
    if (av_frame_make_writable(frame_.get()) < 0) throw std::bad_alloc();
    const uint8_t* const rows[4] = {bgr.data, nullptr, nullptr, nullptr};
    const int strides[4] = {static_cast<int>(bgr.step), 0, 0, 0};
    sws_scale(scaler_.get(), rows, strides, 0, height_, frame_->data, frame_->linesize);
    frame_->pts = next_++;
    Send(frame_.get());
  }

  std::string Finish() {
    Send(nullptr);
    Note(av_write_trailer(output_.get()));
    Note(avio_closep(&output_->pb));
    return error_ < 0 ? LibavReason(error_) : "";
  }

  [[nodiscard]] const std::string& codec() const { return name_; }

 private:
  void OpenCodec(const std::string& path, AVRational fps) {
    name_ = "H.264";
    codec_ = OpenEncoder(avcodec_find_encoder_by_name("libx264"), width_, height_, fps);
    if (codec_) return;
    name_ = "MPEG-4";
    codec_ = OpenEncoder(avcodec_find_encoder(AV_CODEC_ID_MPEG4), width_, height_, fps);
    if (codec_) return;
    throw std::runtime_error(path + ": no encoder for .mp4 (tried H.264 and MPEG-4); install ffmpeg's codec libraries");
  }

  void OpenFile(const std::string& file, const std::string& path) {
    // An absolute path: ffmpeg would take "name:rest" for a protocol.
    const std::string absolute = std::filesystem::absolute(file).string();
    AVFormatContext* output = nullptr;
    if (avformat_alloc_output_context2(&output, nullptr, "mp4", absolute.c_str()) < 0) throw std::bad_alloc();
    output_.reset(output);
    stream_ = avformat_new_stream(output, nullptr);
    if (stream_ == nullptr) throw std::bad_alloc();
    stream_->time_base = codec_->time_base;
    stream_->avg_frame_rate = codec_->framerate;
    int result = avcodec_parameters_from_context(stream_->codecpar, codec_.get());
    if (result >= 0) result = avio_open(&output->pb, absolute.c_str(), AVIO_FLAG_WRITE);
    if (result >= 0) result = avformat_write_header(output, nullptr);
    if (result < 0) throw std::runtime_error(path + ": cannot open for writing: " + LibavReason(result));
  }

  /// Keeps the first error.
  void Note(int result) {
    if (error_ >= 0 && result < 0) error_ = result;
  }

  struct CloseFile {
    void operator()(AVFormatContext* context) const {
      avio_closep(&context->pb);
      avformat_free_context(context);
    }
  };

  /// Encodes a frame, or flushes delayed ones if null, and writes the packets.
  void Send(const AVFrame* frame) {
    if (error_ < 0) return;
    Note(avcodec_send_frame(codec_.get(), frame));
    while (error_ >= 0 && avcodec_receive_packet(codec_.get(), packet_.get()) >= 0) {
      packet_->duration = 1;
      av_packet_rescale_ts(packet_.get(), codec_->time_base, stream_->time_base);
      packet_->stream_index = stream_->index;
      Note(av_write_frame(output_.get(), packet_.get()));
      av_packet_unref(packet_.get());
    }
  }

  int width_, height_;
  std::string name_;
  LibavPtr<AVCodecContext> codec_;
  std::unique_ptr<AVFormatContext, CloseFile> output_;
  AVStream* stream_ = nullptr;
  LibavPtr<AVFrame> frame_;
  LibavPtr<AVPacket> packet_;
  LibavPtr<SwsContext> scaler_;
  cv::Mat padded_;
  int64_t next_ = 0;
  int error_ = 0;
};

VideoEncoder::VideoEncoder(const std::string& file, const std::string& path, int width, int height, double fps)
    : stream_(std::make_unique<Output>(file, path, width, height, fps)) {}
VideoEncoder::~VideoEncoder() = default;
void VideoEncoder::Write(const Image& frame) { stream_->Write(frame); }
std::string VideoEncoder::Finish() { return stream_->Finish(); }
const std::string& VideoEncoder::codec() const { return stream_->codec(); }

}  // namespace bodyloom
