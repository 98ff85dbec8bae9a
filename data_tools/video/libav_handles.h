// SPDX-License-Identifier: Apache-2.0
/// Owners of what ffmpeg's libraries allocate, and their errors as text. Their own headers stay in .cc files.
#pragma once

#include <memory>
#include <string>

struct AVCodecContext;
struct AVFormatContext;
struct AVFrame;
struct AVPacket;
struct SwsContext;

namespace bodyloom {

struct LibavDeleter {
  void operator()(AVCodecContext* context) const;
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

/// What an error code of these libraries means: "Invalid data found when processing input".
std::string LibavReason(int error);

// Keeps ffmpeg's libraries from writing to the terminal: this library reports faults by exceptions.

/// Takes effect once a process; a level other than the libraries' own that a program has set by av_log_set_level stays.
void QuietCodecs();

}  // namespace bodyloom
