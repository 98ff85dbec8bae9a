// SPDX-License-Identifier: Apache-2.0
/// A track as a video, as a contact sheet, or as arrays.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/base/callbacks.h"
#include "pipelines/render/render_picture.h"

namespace bodyloom {

struct RenderTrackRequest {
  std::string track;  ///< .npz
  std::string body;   ///< the track's body; empty: the built-in one
  RenderKind what = RenderKind::kOverlay;
  std::string texture;  ///< for kTexture: the picture, laid out in the body's atlas
  std::string truth;    ///< for kError: the track to compare with, of as many frames, .npz
  VertexErrorUnit error_unit = VertexErrorUnit::kMillimetres;
  double error_maximum = 0;            ///< the last colour, in that unit; 0: 50 mm or 20 px
  std::string video;                   ///< what the person was filmed with, as background; empty: none
  std::string frames;                  ///< FrameRange; empty: all
  std::optional<double> view_yaw_deg;  ///< a camera that follows the person; 90: from its left when it faces the camera
  bool turntable = false;              ///< that camera makes one full turn over the frames
  std::string out;                     ///< .mp4, .png (a contact sheet) or .npz (arrays)
  std::string json;                    ///< ToJson(RenderTrackReport); empty: none
  int num_threads = 0;                 ///< 0: all cores; pictures are the same for any number
};

struct RenderTrackReport {
  std::string what, legend;                           ///< RenderKind by name; what the colours mean
  std::vector<std::string> outputs;                   ///< files written
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

/// Draws the chosen frames and writes what was requested. Throws RequestError when the request contradicts itself,
/// std::runtime_error naming a file that cannot be used, Cancelled. Nothing is left behind then.
RenderTrackReport RenderTrack(const RenderTrackRequest& request, const PipelineCallbacks& callbacks = {});

/// The same for a track in memory, its body, and, when it is given, a true track to compare with: they take the place
/// of the request's files, which then name them in titles and messages.
RenderTrackReport RenderTrack(const RenderTrackRequest& request, const BodyModel& body, const Track& track,
                              const Track* truth, const PipelineCallbacks& callbacks = {});

/// Some lines for a reader, the last one with a newline.
std::string ToText(const RenderTrackReport& report);
/// The same as one JSON object (docs/command.md).
std::string ToJson(const RenderTrackReport& report);

}  // namespace bodyloom
