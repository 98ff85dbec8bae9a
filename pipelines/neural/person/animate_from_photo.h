// SPDX-License-Identifier: Apache-2.0
/// Renders the person of a photo in any motion, by either renderer that was trained for it: what `bodyloom animate
/// photo` and `bodyloom animate guided` do.
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
  std::string data;  ///< a dataset of the same person: its motion is shown, its pictures are compared with, but
                     ///< for those that are photos
  std::optional<MapCompletion> completion;  ///< as PersonRendererRequest
  bool anywhere = false;                    ///< as PersonRendererRequest
  std::string weights;  ///< with `data`: folder with alexnet, lpips_alex and vgg19 (weights_folder.h); empty: none
  std::string surface;  ///< PersonRenderer::SurfacePicture() to write; empty: not written
};

struct AnimateFromPhotoSummary : AnimationSummary {
  double texels_seen = 0;                ///< share of the atlas that the photos show
  double source_seconds = 0;             ///< encoding the photos
  double frame_seconds = 0;              ///< rendering and writing all frames
  std::optional<double> computed_share;  ///< of the window's pixels, mean over frames; absent: not known
  int64_t frames_kept = 0;               ///< that were those before and were not computed again
  std::optional<PersonScores> scores;    ///< against the pictures of `data`
  std::string notes;                     ///< lines: what stands in for what, what is missing; they were messages too

  /// Rendered and written.
  [[nodiscard]] double FramesPerSecond() const { return frames / (frame_seconds > 1e-9 ? frame_seconds : 1e-9); }
};

/// Throws RequestError for a request that contradicts itself, std::runtime_error for files that cannot be used,
/// Cancelled. The stage of `callbacks` is "rendering". In the report maps and networks are part of all frames' time.
AnimateFromPhotoSummary AnimateFromPhoto(const AnimateFromPhotoRequest& request, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
