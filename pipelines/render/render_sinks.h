// SPDX-License-Identifier: Apache-2.0
/// Sinks for the pictures of RenderTrack: a video, a contact sheet, or arrays. A file appears whole at Finish(), or not
/// at all.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "data_tools/formats/npz.h"
#include "data_tools/video/video_writer.h"
#include "pipelines/render/render_picture.h"

namespace bodyloom {

/// One picture to be made: a frame of the track, and how far the camera has turned.
struct RenderStep {
  int frame = 0;
  double turn_deg = 0;
};

class RenderSink {
 public:
  virtual ~RenderSink() = default;
  /// Of all steps, those whose pictures are wanted.
  [[nodiscard]] virtual std::vector<int> Wanted(int num_steps) const;
  /// Makes the picture of a step and takes it.
  virtual void Take(const RenderStep& step, const Image* background, RenderPicture* picture) = 0;
  virtual void Finish() = 0;
};

/// By the extension of `path`: .mp4, .png or .npz (RequestError for others). The lines of `title` head the contact
/// sheet. Arrays of more than 2 GiB are refused (std::runtime_error).
std::unique_ptr<RenderSink> MakeRenderSink(const std::string& path, RenderKind kind,
                                           const std::vector<std::string>& title, const BodyModel& body,
                                           const Track& track, const std::vector<RenderStep>& steps,
                                           const RenderPictureOptions& options, double fps);

}  // namespace bodyloom
