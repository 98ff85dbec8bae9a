// SPDX-License-Identifier: Apache-2.0
/// Sinks for the images of RenderTrack: a video, a contact sheet, or arrays. Files are written whole at Finish(), or
/// not at all.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "data_tools/formats/npz.h"
#include "data_tools/video/video_writer.h"
#include "pipelines/render/frame_renderer.h"

namespace bodyloom {

/// One image to be rendered: a frame of the track, and the angle that the camera has turned.
struct RenderStep {
  int frame = 0;
  double turn_deg = 0;
};

class RenderSink {
 public:
  virtual ~RenderSink() = default;
  /// Indices of the steps whose images the sink uses.
  [[nodiscard]] virtual std::vector<int> Wanted(int num_steps) const;
  /// Renders the image of a step and stores it.
  virtual void Take(const RenderStep& step, const Image* background, FrameRenderer* image) = 0;
  virtual void Finish() = 0;
};

/// Sink by the extension of `path`: .mp4, .png or .npz (RequestError for others). The lines of `title` head the contact
/// sheet. Throws std::runtime_error for arrays of more than 2 GiB.
std::unique_ptr<RenderSink> MakeRenderSink(const std::string& path, RenderKind kind,
                                           const std::vector<std::string>& title, const BodyModel& body,
                                           const Track& track, const std::vector<RenderStep>& steps,
                                           const FrameRendererOptions& options, double fps);

}  // namespace bodyloom
