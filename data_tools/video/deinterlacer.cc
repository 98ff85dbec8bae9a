// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/deinterlacer.h"

extern "C" {
#include <libavfilter/avfilter.h>
#include <libavfilter/buffersink.h>
#include <libavfilter/buffersrc.h>
#include <libavutil/frame.h>
}

#include <stdexcept>

#include "geometry/base/check.h"

namespace bodyloom {

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

}  // namespace bodyloom
