// SPDX-License-Identifier: Apache-2.0
/// Renders a person from one photo in any motion: what `bodyloom animate photo` does.
#pragma once

#include <string>

#include "geometry/base/callbacks.h"
#include "pipelines/neural/photo/photo_animation.h"

namespace bodyloom {

struct AnimatePhotoRequest : PhotoAnimationRequest {
  bool whole_window = false;  ///< the background of the window is computed too
  std::string texture;        ///< the completed texture to write as an image; empty: not written
};

struct AnimatePhotoSummary : AnimationSummary {
  double texels_seen = 0;        ///< share of the texture that the photos show
  double frames_per_second = 0;  ///< rendered and written
  std::string notes;             ///< lines: what stands in for what, what is missing; they were messages too
};

/// Throws RequestError for a request that contradicts itself, std::runtime_error for files that cannot be used,
/// Cancelled. The stage of `callbacks` is "rendering".
AnimatePhotoSummary AnimatePhoto(const AnimatePhotoRequest& request, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
