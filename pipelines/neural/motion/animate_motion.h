// SPDX-License-Identifier: Apache-2.0
/// Renders a person that the motion-dependent renderer learned, in any motion: what `bodyloom animate motion` does.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "geometry/base/callbacks.h"
#include "pipelines/neural/animation.h"
#include "pipelines/neural/motion/clip_scores.h"
#include "render/lighting/fit_lighting.h"

namespace bodyloom {

/// One of `track` and `data` is given.
struct AnimateMotionRequest : AnimationRequest {
  std::string data;      ///< a dataset of the same person: its motion is shown and, unless the view is turned, time
                         ///< stands still or the speed is another, the result compared with its pictures
  std::string iuv;       ///< with `data`: what its pixels show of the body (MotionDataRequest::iuv)
  std::string view_yaw;  ///< degrees that the view is turned by: "30", or "0:360" over the clip
  double speed = 1;      ///< the motion is played so many times as fast
  bool shape_of_track = false;  ///< poses the track's shape, not that of the person who was trained on
  std::string freeze;           ///< "FRAME:COUNT": that frame is shown so many times more; empty: none is
  std::string background;       ///< an image, a video or a folder behind the person; empty: a plain backdrop
  std::string relight;          ///< the light that shall be (pipelines/animate/relight_frames.h); empty: as it is
  bool true_normals = false;    ///< with `relight` and `data`: by the normals of `data`, not the networks'
  int warmup = 50;              ///< passes of the first frame through the network before it counts
  bool without_past = false;    ///< every frame as if it were the first
  bool anywhere = false;        ///< the person may be farther from the body than clothes ever were in training
  std::string like;             ///< with `data`: a dataset or track whose motion each frame's is compared with; of the
                                ///< data that the run was trained on, the frames that it was trained on
  std::string frames;           ///< with `data`: a CSV to write, a line a frame (MotionErrors)
  std::string weights;          ///< with `data`: folder with alexnet and lpips_alex (weights_folder.h); empty: none
  std::string set;              ///< a single-person dataset to write, of the result; empty: none
  std::string set_command;      ///< the command that makes the dataset again, kept in it
};

struct AnimateMotionSummary : AnimationSummary {
  int window_width = 0, window_height = 0;             ///< pixels that the networks draw
  int shrunk_width = 0, shrunk_height = 0;             ///< of the whole picture at the networks' size
  int64_t descriptors_kept = 0, projections_kept = 0;  ///< frames that did not move (MotionRenderer)
  std::optional<FitLightingSummary> light;             ///< of the clip, where it was looked for
  std::optional<ClipScores> scores;                    ///< against the pictures of `data`
};

/// Throws RequestError for a request that contradicts itself, std::runtime_error for files that cannot be used,
/// Cancelled. The stages of `callbacks` are "light", where the clip's light is looked for, and "rendering".
AnimateMotionSummary AnimateMotion(const AnimateMotionRequest& request, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
