// SPDX-License-Identifier: Apache-2.0
/// What `bodyloom render` does: a track as a video, as a contact sheet, or as arrays.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace bodyloom {

struct RenderCommand {
  std::string track, what, out, video, body, frames, texture, json;
  double view_yaw_deg = 0;
  bool has_view_yaw = false, turntable = false;
  int num_threads = 0;  ///< 0: all cores
  bool quiet = false;
};

struct RenderReport {
  std::string what, out, legend;
  std::vector<std::string> outputs;
  int first_frame = 0, num_frames = 0, pictures = 0;  ///< chosen frames of the track; pictures made
  int without_body = 0;                               ///< frames that the track has lost
  int without_video = 0;                              ///< frames at whose time the video has none
  int video_frames_left = 0;                          ///< after the end of the track, as far as the video tells
  int width = 0, height = 0;
  double draw_seconds = 0, total_seconds = 0;
};

/// Frames "a:b" of num_frames (b excluded; either may be missing; "a" alone is one frame) as [first, last+1). Throws
/// RequestError when the text is no such range, std::runtime_error beginning with `where` when it holds no frame.
std::pair<int, int> FrameRange(const std::string& text, int num_frames, const std::string& where);

/// Throws RequestError when options contradict each other, std::runtime_error naming a file that cannot be used. Nothing
/// is left behind then.
RenderReport RunRender(const RenderCommand& command);

std::string ToText(const RenderReport& report);
std::string ToJson(const RenderReport& report);

}  // namespace bodyloom
