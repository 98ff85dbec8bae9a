// SPDX-License-Identifier: Apache-2.0
/// Renders a track as a video, a contact sheet or arrays.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/base/callbacks.h"
#include "pipelines/render/frame_renderer.h"

namespace bodyloom {

struct RenderTrackRequest {
  std::string track;  ///< .npz
  std::string body;   ///< the track's body; empty: the built-in one
  RenderKind what = RenderKind::kOverlay;
  std::string texture;  ///< for kTexture: the image, laid out in the body's atlas
  std::string truth;    ///< for kError: the track to compare with, of as many frames, .npz
  VertexErrorUnit error_unit = VertexErrorUnit::kMillimetres;
  double error_maximum = 0;            ///< the last colour, in that unit; 0: 50 mm or 20 px
  std::string video;                   ///< the source video, as background; empty: none
  std::string frames;                  ///< FrameRange; empty: all
  std::optional<double> view_yaw_deg;  ///< for a camera that follows the person; 90: from the person's left
  bool turntable = false;              ///< this camera makes one full turn over the frames
  std::string out;                     ///< .mp4, .png (a contact sheet) or .npz (arrays)
  std::string json;                    ///< ToJson(RenderTrackReport); empty: none
  int num_threads = 0;                 ///< 0: all cores; images are the same for any number
};

struct RenderTrackReport {
  std::string what, legend;                         ///< RenderKind by name; legend of the colours
  std::vector<std::string> outputs;                 ///< files written
  int first_frame = 0, num_frames = 0, images = 0;  ///< chosen frames of the track; images rendered
  int without_body = 0;                             ///< frames that the track has lost
  int without_video = 0;                            ///< frames at whose time the video has none
  int video_frames_left = 0;                        ///< after the end of the track; 0 if the video's length is unknown
  int width = 0, height = 0;
  double draw_seconds = 0, total_seconds = 0;
};

/// Parses frames "a:b" of num_frames (b excluded; either may be missing; "a" alone is one frame) as [first, last+1).
/// Throws RequestError for a malformed range, std::runtime_error beginning with `where` for an empty one.
std::pair<int, int> FrameRange(const std::string& text, int num_frames, const std::string& where);

/// Draws the chosen frames and writes the requested files. Throws RequestError for a contradictory request,
/// std::runtime_error naming a file that cannot be used, Cancelled; no files are left then.
RenderTrackReport RenderTrack(const RenderTrackRequest& request, const PipelineCallbacks& callbacks = {});

/// The same for a track in memory, its body, and optionally a true track: they replace the request's files, whose names
/// are still used in titles and messages.
RenderTrackReport RenderTrack(const RenderTrackRequest& request, const BodyModel& body, const Track& track,
                              const Track* truth, const PipelineCallbacks& callbacks = {});

/// Several lines of text ending in a newline.
std::string ToText(const RenderTrackReport& report);
/// The same as one JSON object: what, outputs, frames ([first, past the last]), pictures, frames_without_body,
/// pictures_without_video, video_frames_left, image_size, legend, seconds (draw, total).
std::string ToJson(const RenderTrackReport& report);

}  // namespace bodyloom
