// SPDX-License-Identifier: Apache-2.0
/// Owning handles of objects of ffmpeg's libraries, and their errors as text. ffmpeg headers are only included in .cc
/// files.
#pragma once

#include <memory>
#include <string>

struct AVCodecContext;
struct AVFilterGraph;
struct AVFormatContext;
struct AVFrame;
struct AVPacket;
struct SwsContext;

namespace bodyloom {

struct LibavDeleter {
  void operator()(AVCodecContext* context) const;
  void operator()(AVFilterGraph* graph) const;
  void operator()(AVFormatContext* context) const;
  void operator()(AVFrame* frame) const;
  void operator()(AVPacket* packet) const;
  void operator()(SwsContext* context) const;
};

template <typename T>
using LibavPtr = std::unique_ptr<T, LibavDeleter>;

/// Throw std::bad_alloc.
LibavPtr<AVFrame> NewLibavFrame();
LibavPtr<AVPacket> NewLibavPacket();

/// Text of an error code of these libraries: "Invalid data found when processing input".
std::string LibavReason(int error);

// Silences ffmpeg's libraries, as this library reports faults by exceptions.

/// Takes effect once per process; a level that a program has set by av_log_set_level is kept.
void QuietCodecs();

}  // namespace bodyloom
