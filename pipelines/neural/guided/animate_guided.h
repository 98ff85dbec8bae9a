// SPDX-License-Identifier: Apache-2.0
/// Animates the person of a photo with the pose-guided renderer: what `bodyloom animate guided` does.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "geometry/base/callbacks.h"
#include "neural/guided/guided_config.h"
#include "neural/guided/guided_scores.h"
#include "pipelines/neural/photo/photo_animation.h"

namespace bodyloom {

/// One of `track` and `data` is given; with `data` neither view_yaw nor garment.
struct AnimateGuidedRequest : PhotoAnimationRequest {
  std::string data;  ///< a dataset of the same person: its motion is shown, its pictures are compared with, but
                     ///< for those that are photos
  std::optional<MapCompletion> completion;  ///< of what the photos do not show; absent: as the run says
  bool anywhere = false;  ///< the person may be farther from the body than clothes ever were in training
  std::string weights;    ///< with `data`: folder with alexnet, lpips_alex and vgg19 (weights_folder.h); empty: none
  std::string uv_maps;    ///< a picture of the coherent maps to write; empty: not written
};

struct AnimateGuidedSummary : AnimationSummary {
  double source_seconds = 0;           ///< encoding the photo
  double frame_seconds = 0;            ///< rendering and writing all frames
  double computed_share = 0;           ///< of the window's pixels, mean over frames
  int64_t frames_kept = 0;             ///< that were those before and were not computed again
  std::optional<GuidedScores> scores;  ///< against the pictures of `data`
  std::string notes;                   ///< lines: what stands in for what, what is missing; they were messages too
};

/// Throws RequestError for a request that contradicts itself, std::runtime_error for files that cannot be used,
/// Cancelled. The stage of `callbacks` is "rendering".
AnimateGuidedSummary AnimateGuided(const AnimateGuidedRequest& request, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
