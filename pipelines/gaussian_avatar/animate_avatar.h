// SPDX-License-Identifier: Apache-2.0
/// Renders a Gaussian avatar in any motion; implements `bodyloom animate avatar`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "geometry/base/stopwatch.h"
#include "geometry/scene/track.h"
#include "pipelines/gaussian_avatar/avatar_scores.h"
#include "pipelines/gaussian_avatar/shown_avatar.h"

namespace bodyloom {

/// One of `track` and `data` is given, or both with a video.
struct AnimateAvatarRequest {
  std::string run;                ///< folder of the trained run, or its avatar.npz
  std::string track;              ///< the motion, .npz; empty: that of `data`
  const Track* motion = nullptr;  ///< the motion in memory, borrowed; `track` is then its name in messages
  std::string data;             ///< images to compare with: a single-person dataset, or a video with `track` and `mask`
  std::string mask;             ///< of the video
  std::string body;             ///< the track's body; empty: the built-in body
  std::string view_yaw;         ///< how far the view is turned (pipelines/animate/animation_limits.h)
  std::string freeze;           ///< frames shown repeatedly (pipelines/animate/animation_limits.h); empty: none
  std::string background;       ///< an image, a video or a folder behind the person; empty: a plain backdrop
  int size = 0;                 ///< pixels of the image's longer side; 0: as the track's
  bool shape_of_track = false;  ///< poses the track's shape, not that of the person who was trained on
  std::string out;              ///< the video to write, .mp4; empty: none
  std::string pictures;         ///< a folder for PNGs with transparency, 000000.png …; empty: none
  std::string set;              ///< a single-person dataset of what is shown (avatar_image.h); empty: none
  std::string ply;              ///< the Gaussians at rest, .ply; empty: none
  std::string posed_ply;        ///< the Gaussians of frame posed_frame, in the camera's frame, .ply; empty: none
  int posed_frame = 0;
  /// HTML file with an interactive view of the person (pipelines/gaussian_avatar/avatar_page.h); empty: none
  std::string report;
  std::string json;  ///< a report; empty: none
  int threads = 0;   ///< 0: all cores
};

struct AnimateAvatarSummary {
  int frames = 0, frames_without_fit = 0;
  int width = 0, height = 0;  ///< of the images
  int gaussians = 0;
  double draw_ms = 0;                  ///< median of posing and drawing a frame
  double pixels = 0;                   ///< median of the windows drawn
  std::optional<AvatarScores> scores;  ///< against `data`
  StageSeconds seconds;
  double total_seconds = 0;
  std::vector<std::string> written;
};

/// Renders the request's frames. Throws RequestError for a contradictory request, std::runtime_error for files that
/// cannot be used, Cancelled.
AnimateAvatarSummary AnimateAvatar(const AnimateAvatarRequest& request, const PipelineCallbacks& callbacks = {});
/// The same for an avatar in memory; the request's run and body are ignored.
AnimateAvatarSummary AnimateLearnedAvatar(const LearnedAvatar& avatar, const AnimateAvatarRequest& request,
                                          const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
