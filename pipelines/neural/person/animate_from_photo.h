// SPDX-License-Identifier: Apache-2.0
/// Renders the person of a photo in any motion by the one-photo or the pose-guided renderer; implements `bodyloom
/// animate photo` and `bodyloom animate guided`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "geometry/base/callbacks.h"
#include "neural/metrics/person_scores.h"
#include "pipelines/neural/person/person_renderer.h"
#include "pipelines/neural/person/photo_animation.h"

namespace bodyloom {

/// One of `track` and `data` is given; with `data` neither view_yaw nor garment.
struct AnimateFromPhotoRequest : PhotoAnimationRequest {
  PersonRendererKind renderer = PersonRendererKind::kPhoto;
  std::string data;  ///< a dataset of the same person: its motion is shown, its images are compared with, but
                     ///< for those that are photos
  std::optional<MapCompletion> completion;  ///< as PersonRendererRequest
  bool whole_window = false;                ///< as PersonRendererRequest
  std::string weights;  ///< with `data`: folder with alexnet, lpips_alex and vgg19 (weights_folder.h); empty: none
  std::string surface;  ///< PersonRenderer::SurfaceImage() to write; empty: not written
};

struct AnimateFromPhotoSummary : AnimationSummary {
  double texels_seen = 0;                ///< share of the atlas covered by the photos
  double source_seconds = 0;             ///< encoding the photos
  double frame_seconds = 0;              ///< rendering and writing all frames
  std::optional<double> computed_share;  ///< share of the window's pixels, mean over frames; absent: unknown
  int64_t frames_kept = 0;               ///< equal to the previous one, not recomputed
  std::optional<PersonScores> scores;    ///< against the images of `data`
  std::string notes;                     ///< lines on substitutes and missing data, also sent as messages

  /// Rate of rendering and writing.
  [[nodiscard]] double FramesPerSecond() const { return frames / (frame_seconds > 1e-9 ? frame_seconds : 1e-9); }
};

/// Renders the request's frames. Throws RequestError for a contradictory request, std::runtime_error for files that
/// cannot be used, Cancelled. The stage of `callbacks` is "rendering". The report's time of all frames includes maps
/// and networks.
AnimateFromPhotoSummary AnimateFromPhoto(const AnimateFromPhotoRequest& request, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
