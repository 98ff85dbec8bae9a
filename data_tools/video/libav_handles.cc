// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/libav_handles.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavfilter/avfilter.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

#include <new>

namespace bodyloom {

void LibavDeleter::operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
void LibavDeleter::operator()(AVFilterGraph* graph) const { avfilter_graph_free(&graph); }
void LibavDeleter::operator()(AVFormatContext* context) const { avformat_close_input(&context); }
void LibavDeleter::operator()(AVFrame* frame) const { av_frame_free(&frame); }
void LibavDeleter::operator()(AVPacket* packet) const { av_packet_free(&packet); }
void LibavDeleter::operator()(SwsContext* context) const { sws_freeContext(context); }

LibavPtr<AVFrame> NewLibavFrame() {
  LibavPtr<AVFrame> frame(av_frame_alloc());
  if (!frame) throw std::bad_alloc();
  return frame;
}

LibavPtr<AVPacket> NewLibavPacket() {
  LibavPtr<AVPacket> packet(av_packet_alloc());
  if (!packet) throw std::bad_alloc();
  return packet;
}

std::string LibavReason(int error) {
  char text[AV_ERROR_MAX_STRING_SIZE] = "";
  av_strerror(error, text, sizeof text);
  return text;
}

}  // namespace bodyloom

extern "C" {
#include <libavutil/log.h>
}

#include <mutex>

namespace bodyloom {

void QuietCodecs() {
  static std::once_flag once;
  std::call_once(once, [] {
    if (av_log_get_level() == AV_LOG_INFO) av_log_set_level(AV_LOG_QUIET);
  });
}

}  // namespace bodyloom
